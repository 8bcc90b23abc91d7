// Pictures without a window.
#pragma once

#include "src/view/render/gl_context.h"
#include "src/view/render/image.h"
#include "src/view/render/renderer.h"

namespace tutu::app {

struct OffscreenOptions {
  int width = 1280, height = 720; ///< pixels of the finished picture, each 1 to 8192
  int supersample = 1;            ///< 1 to 4: draws this many times larger in each direction and averages
};

/// Its own context, framebuffer and renderer. Use one object from one thread at a time.
class Offscreen {
public:
  /// Throws std::runtime_error when there is no OpenGL to be had, std::invalid_argument for sizes out of range.
  explicit Offscreen(const OffscreenOptions& options);
  ~Offscreen();

  Image draw(const FrameView& view, const Camera& camera);
  /// The same into memory that is used again, for videos.
  void draw(const FrameView& view, const Camera& camera, Image& image);

  float aspect() const { return static_cast<float>(options_.width) / static_cast<float>(options_.height); }
  std::string description() const { return context_.description(); }

private:
  struct Target;
  OffscreenOptions options_;
  GlContext context_; ///< before what lives in it
  std::unique_ptr<Target> target_;
  std::unique_ptr<Renderer> renderer_;
  std::vector<std::uint8_t> raw_; ///< RGBA, bottom row first, before averaging
};

/// Averages `factor` x `factor` blocks in linear light. `raw`: RGBA, bottom row first, `factor` times the image's size.
void reduce(const std::vector<std::uint8_t>& raw, int factor, Image& image);

} // namespace tutu::app
