// Draws a frame: a bright studio with a floor, soft shadows, lit surfaces, and the overlays.
#pragma once

#include "src/view/render/frame_view.h"

#include <memory>

namespace tutu::app {

/// An OpenGL 3.3 core context must be current in every function, the destructor included; the buffers belong to it.
/// The same frame, camera and size give the same bytes on Mesa's software rasteriser.
class Renderer {
public:
  /// Throws std::runtime_error when the driver cannot do what is needed.
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Fills the bound framebuffer (8 bits a channel, not sRGB-encoding; depth and stencil), `width` x `height` pixels.
  /// `pixel_scale`: how many of these pixels make one of the finished picture in each direction, for lines and points.
  /// `left`: pixels of the framebuffer beside it, which are left alone but for their depth and stencil.
  /// Throws std::invalid_argument when a surface's spans do not fit each other; positions may hold anything.
  void draw(const FrameView& view, const Camera& camera, int width, int height, float pixel_scale = 1.0f, int left = 0);

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace tutu::app
