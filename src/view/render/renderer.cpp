#include "src/view/render/renderer.h"

#include "src/view/render/overlay.h"
#include "src/view/render/shaders.h"
#include "src/view/render/shadow.h"
#include "src/view/render/surface_buffers.h"

#include <algorithm>
#include <cmath>

namespace tutu::app {
namespace {

constexpr float k_particle_radius = 0.0035f; // m
constexpr float k_mark_radius = 0.0055f;     // m
constexpr float k_floor_radius = 30.0f;      // m; its edge is long since one with the backdrop
constexpr float k_view_reach = 60.0f;        // m beyond the target
constexpr float k_widest_scene = 25.0f;      // m from the target: what flew further casts no shadow

struct Box {
  Vec3f lo = Vec3f::Constant(1e30f), hi = Vec3f::Constant(-1e30f);
};

/// Of all positions within reach of `about`; a diverged garment must not spoil the light for the rest.
Box bounds_of(const FrameView& view, const Vec3f& about) {
  Box box;
  for (const SurfaceView& surface : view.surfaces)
    for (const Vec3f& p : surface.positions) {
      if (!((p - about).cwiseAbs().maxCoeff() < k_widest_scene)) continue; // so written for NaN
      box.lo = box.lo.cwiseMin(p);
      box.hi = box.hi.cwiseMax(p);
    }
  return box.lo.x() <= box.hi.x() ? box : Box{about, about};
}

} // namespace

struct Renderer::Parts {
  Program surface{"surface", shaders::k_surface_vertex, shaders::k_surface_fragment};
  Program wire{"wire", shaders::k_surface_vertex, shaders::k_wire_fragment};
  Program ground{"ground", shaders::k_ground_vertex, shaders::k_ground_fragment};
  Program backdrop{"backdrop", shaders::k_fullscreen_vertex, shaders::k_backdrop_fragment};
  VertexArray nothing; ///< core OpenGL wants one bound even for shaders without input
  ShadowMaps shadows;
  Overlay overlay;
  std::vector<SurfaceBuffers> surfaces; ///< never shrinks; the first ones are this frame's

  void draw_surfaces(std::span<const SurfaceBuffers> all, const FrameView& view, const Camera& camera,
                     const LightFit& light, const PictureFit& fit);
  void draw_wires(std::span<const SurfaceBuffers> all, const PictureFit& fit);
  void draw_ground(float height, const Box& box, const LightFit& light, const PictureFit& fit);
  void draw_backdrop(const PictureFit& fit);
};

Renderer::Renderer() : parts_(std::make_unique<Parts>()) {}
Renderer::~Renderer() = default;

void Renderer::draw(const FrameView& view, const Camera& camera, int width, int height, float pixel_scale, int left) {
  Parts& parts = *parts_;
  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_DITHER);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glFrontFace(GL_CCW);

  if (parts.surfaces.size() < view.surfaces.size()) parts.surfaces.resize(view.surfaces.size());
  for (std::size_t i = 0; i < view.surfaces.size(); ++i) parts.surfaces[i].update(view.surfaces[i]);
  const std::span<const SurfaceBuffers> surfaces(parts.surfaces.data(), view.surfaces.size());
  const Box box = bounds_of(view, camera.target);
  const LightFit light = fit_light(box.lo, box.hi, view.ground_height);
  parts.shadows.draw(surfaces, light, view.ground);

  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
  glViewport(left, 0, width, height);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glClear(GL_DEPTH_BUFFER_BIT);
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  const float distance = (camera.target - camera.eye).norm(), near_distance = std::max(0.02f, 0.02f * distance);
  const PictureFit fit{.clip_from_world = clip_from_view(camera, w / h, near_distance, distance + k_view_reach) *
                                          view_from_world(camera),
                       .eye = camera.eye,
                       .picture = {w, h},
                       .corner = {static_cast<float>(left), 0.0f},
                       .pixel_scale = pixel_scale};
  // Front to back, so that each pixel is shaded once.
  parts.draw_surfaces(surfaces, view, camera, light, fit);
  if (view.ground && camera.eye.y() > view.ground_height) parts.draw_ground(view.ground_height, box, light, fit);
  parts.draw_backdrop(fit);
  parts.draw_wires(surfaces, fit);
  const float pixels_per_metre = 0.5f * h / std::tan(0.5f * camera.vertical_fov);
  parts.overlay.draw_threads(view.threads, fit);
  parts.overlay.draw_points(view.points, k_particle_radius, pixels_per_metre, fit);
  parts.overlay.draw_capsules(view.capsules, fit);
  parts.overlay.draw_lines(view.lines, fit);
  parts.overlay.draw_marks(view.marks, k_mark_radius, pixels_per_metre, fit);
  glBindVertexArray(0);
}

void Renderer::Parts::draw_surfaces(std::span<const SurfaceBuffers> all, const FrameView& view, const Camera& camera,
                                    const LightFit& light, const PictureFit& fit) {
  use_for_picture(surface, fit);
  surface.set("light_from_world", light.texture_from_world);
  surface.set("shadow_bias", 1.5f * light.texel);
  surface.set("texel", 1.0f / static_cast<float>(ShadowMaps::k_map_size));
  surface.set("key_direction", key_direction());
  const Mat4f turn = view_from_world(camera);
  const Vec3f right = turn.block<1, 3>(0, 0), up = turn.block<1, 3>(1, 0), back = turn.block<1, 3>(2, 0);
  surface.set("rim_direction", Vec3f((0.45f * right + 0.6f * up - 0.65f * back).normalized()));
  surface.set("ground_height", view.ground ? view.ground_height : -1e6f);
  surface.set("shadow_map", 0);
  bind_texture(0, shadows.depth_texture());
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  for (const SurfaceBuffers& one : all) {
    surface.set("offset", one.offset());
    surface.set("sheen", one.sheen());
    surface.set("first_back", one.first_back());
    one.draw();
  }
}

void Renderer::Parts::draw_wires(std::span<const SurfaceBuffers> all, const PictureFit& fit) {
  if (std::none_of(all.begin(), all.end(), [](const SurfaceBuffers& one) { return one.wireframe(); })) return;
  use_for_picture(wire, fit);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glEnable(GL_POLYGON_OFFSET_LINE);
  glPolygonOffset(-1.0f, -2.0f);
  glEnable(GL_CULL_FACE);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  for (const SurfaceBuffers& one : all) {
    if (!one.wireframe()) continue;
    wire.set("offset", one.offset());
    one.draw();
  }
  glDisable(GL_BLEND);
  glDisable(GL_POLYGON_OFFSET_LINE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void Renderer::Parts::draw_ground(float height, const Box& box, const LightFit& light, const PictureFit& fit) {
  const Vec3f centre(0.5f * (box.lo.x() + box.hi.x()), height, 0.5f * (box.lo.z() + box.hi.z()));
  use_for_picture(ground, fit);
  ground.set("centre", centre);
  ground.set("radius", k_floor_radius);
  ground.set("pool", std::max(1.0f, 0.9f * (box.hi - box.lo).norm()));
  ground.set("mask_scale", Eigen::Vector2f(1.0f / light.mask_size, -1.0f / light.mask_size));
  ground.set("mask_shift", Eigen::Vector2f((centre.x() - light.mask_corner.x()) / light.mask_size,
                                           (centre.z() - light.mask_corner.z()) / light.mask_size));
  ground.set("near_mask", 0);
  ground.set("wide_mask", 1);
  bind_texture(1, shadows.wide_mask());
  bind_texture(0, shadows.near_mask());
  glBindVertexArray(nothing.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void Renderer::Parts::draw_backdrop(const PictureFit& fit) {
  use_for_picture(backdrop, fit);
  glDepthFunc(GL_LEQUAL); // it lies exactly on the far plane
  glDepthMask(GL_FALSE);
  glBindVertexArray(nothing.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

} // namespace tutu::app
