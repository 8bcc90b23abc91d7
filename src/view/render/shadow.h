// The key light's shadows: a depth map for the surfaces, and two blurred masks of it for the floor.
#pragma once

#include "src/view/render/gl_objects.h"
#include "src/view/render/surface_buffers.h"

#include <span>

namespace tutu::app {

/// Unit, towards the key light: from the front left, high up.
Vec3f key_direction();

/// A parallel light's view of the scene. The numbers move in whole steps, so that shadows do not crawl when the
/// scene's box breathes.
struct LightFit {
  Mat4f clip_from_world = Mat4f::Identity();
  Mat4f texture_from_world = Mat4f::Identity(); ///< 0..1 in all axes
  float texel = 0;                              ///< m, a texel of the shadow map
  float depth_range = 0;                        ///< m, what 0..1 of depth spans
  Vec3f mask_corner = Vec3f::Zero();            ///< on the floor, smallest x and z
  float mask_size = 0;                          ///< m, side of the square on the floor that the masks cover
};

LightFit fit_light(const Vec3f& lo, const Vec3f& hi, float ground_height);

class ShadowMaps {
public:
  static constexpr int k_map_size = 1024, k_near_size = 192, k_wide_size = 96;

  ShadowMaps();

  /// Draws the surfaces as the light sees them and, if asked, the floor's masks. Leaves its own framebuffer bound.
  void draw(std::span<const SurfaceBuffers> surfaces, const LightFit& light, bool ground);

  GLuint depth_texture() const { return depth_.name(); }    ///< to sample with comparison
  GLuint near_mask() const { return near_.front().name(); } ///< red: blocked, green: blocked close by; blurred a little
  GLuint wide_mask() const { return wide_.front().name(); } ///< the same, blurred a lot

private:
  void blur(const std::array<Texture, 2>& textures, int size, float step_texels);

  Program depth_program_, mask_program_, blur_program_;
  Texture depth_;
  std::array<Texture, 2> near_, wide_; ///< result, and the blur's half-way house
  Framebuffer depth_target_, mask_target_;
  VertexArray nothing_; ///< core OpenGL wants one bound even for shaders without input
};

} // namespace tutu::app
