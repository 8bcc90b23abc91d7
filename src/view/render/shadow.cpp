#include "src/view/render/shadow.h"

#include "src/view/render/shaders.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tutu::app {
namespace {

void make_mask_texture(const Texture& texture, int size) {
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG8, size, size, 0, GL_RG, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
}

float snap(float value, float step) { return std::floor(value / step) * step; }

} // namespace

Vec3f key_direction() { return Vec3f(-0.42f, 0.90f, 0.52f).normalized(); }

LightFit fit_light(const Vec3f& lo, const Vec3f& hi, float ground_height) {
  const Vec3f centre = 0.5f * (lo + hi), towards = key_direction();
  const float radius = snap(0.5f * (hi - lo).norm(), 0.1f) + 0.2f;

  LightFit light;
  light.texel = 2 * radius / static_cast<float>(ShadowMaps::k_map_size);
  // From the light's view the scene is a ball; behind it lies the floor, which asks the map too.
  const Mat4f view = view_from_world({.eye = towards, .target = Vec3f::Zero()});
  Vec3f seen = (view * centre.homogeneous()).head<3>();
  seen = {snap(seen.x(), light.texel), snap(seen.y(), light.texel), snap(seen.z(), 0.1f)};
  const Vec3f reach(radius, radius, radius + 0.1f);
  light.depth_range = 2 * reach.z();
  light.clip_from_world = orthographic(seen - reach, seen + reach) * view;
  Mat4f halve = Mat4f::Identity();
  halve.diagonal() << 0.5f, 0.5f, 0.5f, 1.0f;
  halve.topRightCorner<3, 1>().setConstant(0.5f);
  light.texture_from_world = halve * light.clip_from_world;

  // The ball's shadow on the floor is an ellipse, longer by 1 / sin(elevation).
  const Vec3f landing = centre - towards * ((centre.y() - ground_height) / towards.y());
  const float half = radius / towards.y() + 0.25f;
  light.mask_size = 2 * half;
  const float step = light.mask_size / static_cast<float>(ShadowMaps::k_wide_size);
  light.mask_corner = {snap(landing.x() - half, step), ground_height, snap(landing.z() - half, step)};
  return light;
}

ShadowMaps::ShadowMaps()
    : depth_program_("depth", shaders::k_depth_vertex, shaders::k_depth_fragment),
      mask_program_("ground mask", shaders::k_fullscreen_vertex, shaders::k_ground_mask_fragment),
      blur_program_("blur", shaders::k_fullscreen_vertex, shaders::k_blur_fragment) {
  bind_texture(0, depth_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, k_map_size, k_map_size, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const std::array<float, 4> far_away = {1, 1, 1, 1};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, far_away.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  for (const Texture& texture : near_) make_mask_texture(texture, k_near_size);
  for (const Texture& texture : wide_) make_mask_texture(texture, k_wide_size);

  glBindFramebuffer(GL_FRAMEBUFFER, depth_target_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the graphics driver cannot draw shadow maps");
}

void ShadowMaps::draw(std::span<const SurfaceBuffers> surfaces, const LightFit& light, bool ground) {
  glBindFramebuffer(GL_FRAMEBUFFER, depth_target_.name());
  glViewport(0, 0, k_map_size, k_map_size);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glClear(GL_DEPTH_BUFFER_BIT);
  depth_program_.use();
  depth_program_.set("clip_from_world", light.clip_from_world);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 2.0f);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  for (const SurfaceBuffers& surface : surfaces) {
    depth_program_.set("offset", surface.offset());
    surface.draw();
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_TEST);
  if (!ground) return;

  glBindVertexArray(nothing_.name());
  glBindFramebuffer(GL_FRAMEBUFFER, mask_target_.name());
  mask_program_.use();
  mask_program_.set("light_from_world", light.texture_from_world);
  mask_program_.set("corner", light.mask_corner);
  mask_program_.set("size", light.mask_size);
  mask_program_.set("depth_range", light.depth_range);
  mask_program_.set("rise", key_direction().y());
  mask_program_.set("shadow_depth", 0);
  bind_texture(0, depth_.name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  for (const auto& [textures, size] : {std::pair(&near_, k_near_size), std::pair(&wide_, k_wide_size)}) {
    mask_program_.set("shadow_radius", light.mask_size / (static_cast<float>(size) * light.texel * k_map_size));
    glViewport(0, 0, size, size);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures->front().name(), 0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  blur(near_, k_near_size, 1.0f);
  blur(wide_, k_wide_size, 2.0f);
}

void ShadowMaps::blur(const std::array<Texture, 2>& textures, int size, float step_texels) {
  blur_program_.use();
  blur_program_.set("image", 0);
  glViewport(0, 0, size, size);
  const float pitch = step_texels / static_cast<float>(size);
  for (const std::size_t from : {std::size_t{0}, std::size_t{1}}) {
    bind_texture(0, textures[from].name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[1 - from].name(), 0);
    blur_program_.set("pitch", from == 0 ? Eigen::Vector2f(pitch, 0) : Eigen::Vector2f(0, pitch));
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
}

} // namespace tutu::app
