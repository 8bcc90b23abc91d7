#include "src/view/window/orbit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::app {
namespace {

constexpr float k_most_pitch = 1.5f; // rad; a little short of straight up, where yaw would lose its meaning
constexpr float k_nearest = 0.05f, k_farthest = 100.0f; // m
constexpr float k_notch = 1.12f;                        // factor of distance a wheel notch

} // namespace

Camera OrbitCamera::camera() const {
  return {.eye = target + distance * eye_direction(yaw, pitch), .target = target, .vertical_fov = vertical_fov};
}

void rotate(OrbitCamera& orbit, float dx, float dy, int height) {
  const float angle = std::numbers::pi_v<float> / static_cast<float>(std::max(height, 1)); // half a turn a picture
  orbit.yaw = std::remainder(orbit.yaw - dx * angle, 2 * std::numbers::pi_v<float>);
  orbit.pitch = std::clamp(orbit.pitch + dy * angle, -k_most_pitch, k_most_pitch);
}

void pan(OrbitCamera& orbit, float dx, float dy, int height) {
  const float metres_per_pixel =
      2 * orbit.distance * std::tan(0.5f * orbit.vertical_fov) / static_cast<float>(std::max(height, 1));
  const Mat4f view = view_from_world(orbit.camera());
  const Vec3f right = view.block<1, 3>(0, 0), up = view.block<1, 3>(1, 0);
  orbit.target += metres_per_pixel * (dy * up - dx * right);
}

void zoom(OrbitCamera& orbit, float notches) {
  orbit.distance = std::clamp(orbit.distance * std::pow(k_notch, -notches), k_nearest, k_farthest);
}

OrbitCamera frame_orbit(const Vec3f& lo, const Vec3f& hi, float yaw, float pitch, float aspect) {
  const Camera camera = frame_camera(lo, hi, yaw, pitch, aspect);
  return {.target = camera.target,
          .yaw = yaw,
          .pitch = pitch,
          .distance = (camera.eye - camera.target).norm(),
          .vertical_fov = camera.vertical_fov};
}

} // namespace tutu::app
