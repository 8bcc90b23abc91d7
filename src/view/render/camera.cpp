#include "src/view/render/camera.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tutu::app {
namespace {

constexpr float k_margin = 1.06f; // of the half picture: air around a framed box

/// Right, up and backwards of the camera as rows.
Eigen::Matrix3f axes(const Camera& camera) {
  Vec3f back = camera.eye - camera.target;
  back = back.norm() > 0 ? Vec3f(back.normalized()) : Vec3f::UnitZ();
  Vec3f right = Vec3f::UnitY().cross(back);
  right = right.norm() > 1e-4f ? Vec3f(right.normalized()) : Vec3f::UnitX();
  Eigen::Matrix3f rows;
  rows.row(0) = right;
  rows.row(1) = back.cross(right);
  rows.row(2) = back;
  return rows;
}

} // namespace

Mat4f view_from_world(const Camera& camera) {
  Mat4f view = Mat4f::Identity();
  view.topLeftCorner<3, 3>() = axes(camera);
  view.topRightCorner<3, 1>() = -(view.topLeftCorner<3, 3>() * camera.eye);
  return view;
}

Mat4f clip_from_view(const Camera& camera, float aspect, float near_distance, float far_distance) {
  const float scale = 1.0f / std::tan(0.5f * camera.vertical_fov);
  Mat4f clip = Mat4f::Zero();
  clip(0, 0) = scale / aspect;
  clip(1, 1) = scale;
  clip(2, 2) = (far_distance + near_distance) / (near_distance - far_distance);
  clip(2, 3) = 2.0f * far_distance * near_distance / (near_distance - far_distance);
  clip(3, 2) = -1.0f;
  return clip;
}

Mat4f orthographic(const Vec3f& lo, const Vec3f& hi) {
  const Vec3f size = hi - lo, centre = 0.5f * (hi + lo);
  Mat4f clip = Mat4f::Identity();
  clip(0, 0) = 2.0f / size.x();
  clip(1, 1) = 2.0f / size.y();
  clip(2, 2) = -2.0f / size.z(); // view space looks along -z, depth grows along +z
  clip(0, 3) = -centre.x() * clip(0, 0);
  clip(1, 3) = -centre.y() * clip(1, 1);
  clip(2, 3) = -centre.z() * clip(2, 2);
  return clip;
}

std::optional<Eigen::Vector2f> project(const Camera& camera, int width, int height, const Vec3f& point) {
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  const Vec3f seen = axes(camera) * (point - camera.eye);
  if (seen.z() >= 0) return std::nullopt;
  const float scale = 0.5f * h / (std::tan(0.5f * camera.vertical_fov) * -seen.z());
  return Eigen::Vector2f(0.5f * w + scale * seen.x(), 0.5f * h - scale * seen.y());
}

Vec3f ray_through(const Camera& camera, int width, int height, const Eigen::Vector2f& pixel) {
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  const float scale = 2.0f * std::tan(0.5f * camera.vertical_fov) / h;
  const Vec3f seen(scale * (pixel.x() - 0.5f * w), scale * (0.5f * h - pixel.y()), -1.0f);
  return (axes(camera).transpose() * seen).normalized();
}

Vec3f eye_direction(float yaw, float pitch) {
  return {std::cos(pitch) * std::sin(yaw), std::sin(pitch), std::cos(pitch) * std::cos(yaw)};
}

Camera frame_camera(std::span<const Vec3f> points, float yaw, float pitch, float aspect) {
  Eigen::AlignedBox3f box;
  for (const Vec3f& point : points) box.extend(point);
  Camera camera;
  camera.target = box.center();
  const Vec3f direction = eye_direction(yaw, pitch);
  camera.eye = camera.target + direction;
  const Eigen::Matrix3f rows = axes(camera);
  const float tangent_y = std::tan(0.5f * camera.vertical_fov), tangent_x = tangent_y * aspect;
  float distance = 0.1f;
  constexpr int k_rounds = 4; // each round centres what the last one framed; the shift shrinks by far more than half
  for (int round = 0; round < k_rounds; ++round) {
    // A point at (x, y, z) of the camera's axes about the target is inside when |x| <= tangent * (distance - z).
    distance = 0.1f;
    for (const Vec3f& point : points) {
      const Vec3f seen = rows * (point - camera.target);
      distance = std::max({distance, seen.z() + k_margin * std::abs(seen.x()) / tangent_x,
                           seen.z() + k_margin * std::abs(seen.y()) / tangent_y});
    }
    if (round + 1 == k_rounds) break;
    Eigen::AlignedBox2f picture; // slopes of the lines of sight
    for (const Vec3f& point : points) {
      const Vec3f seen = rows * (point - camera.target);
      picture.extend(Eigen::Vector2f(seen.head<2>() / (distance - seen.z())));
    }
    const Eigen::Vector2f middle = distance * picture.center();
    camera.target += rows.transpose() * Vec3f(middle.x(), middle.y(), 0.0f);
  }
  camera.eye = camera.target + distance * direction;
  return camera;
}

Camera frame_camera(const Vec3f& lo, const Vec3f& hi, float yaw, float pitch, float aspect) {
  std::array<Vec3f, 8> corners;
  for (int corner = 0; corner < 8; ++corner)
    corners[corner] = {(corner & 1 ? hi : lo).x(), (corner & 2 ? hi : lo).y(), (corner & 4 ? hi : lo).z()};
  return frame_camera(corners, yaw, pitch, aspect);
}

} // namespace tutu::app
