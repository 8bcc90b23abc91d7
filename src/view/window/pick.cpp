#include "src/view/window/pick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tutu::app {
namespace {

constexpr int k_ring_points = 128;

} // namespace

Ray ray_through(const Picture& picture, double x, double y) {
  const Camera& camera = picture.camera;
  // As view_from_world() has it, in double.
  const Vec3 forward = (camera.target.cast<double>() - camera.eye.cast<double>()).normalized();
  Vec3 right = forward.cross(Vec3::UnitY());
  right = right.norm() > 1e-4 ? Vec3(right.normalized()) : Vec3(Vec3::UnitX());
  const Vec3 up = right.cross(forward);
  const double per_pixel = 2.0 * std::tan(0.5 * static_cast<double>(camera.vertical_fov)) / picture.height;
  const Vec3 direction = forward + per_pixel * ((x - 0.5 * picture.width) * right + (0.5 * picture.height - y) * up);
  return {camera.eye.cast<double>(), direction.normalized()};
}

std::optional<Vec3> on_plane(const Ray& ray, const Vec3& point, const Vec3& normal) {
  const double slope = ray.direction.dot(normal);
  if (!(std::abs(slope) > 1e-6 * normal.norm())) return std::nullopt;
  const double distance = (point - ray.origin).dot(normal) / slope;
  if (!(distance > 0.0)) return std::nullopt;
  return ray.origin + distance * ray.direction;
}

Vec3 on_sphere(const Ray& ray, const Vec3& centre, double radius, const Vec3& near) {
  const double along = (centre - ray.origin).dot(ray.direction);
  const Vec3 foot = ray.origin + along * ray.direction;
  const double inside = radius * radius - (foot - centre).squaredNorm();
  if (!(inside > 0.0)) return foot;
  const Vec3 half = std::sqrt(inside) * ray.direction;
  const Vec3 front = foot - half, back = foot + half;
  return (front - near).squaredNorm() <= (back - near).squaredNorm() ? front : back;
}

std::optional<int> nearest_joint(const Picture& picture, std::span<const Transform> model_from_joint, double x,
                                 double y, double reach) {
  constexpr double k_one_place = 1.0; // px
  std::optional<int> best;
  double best_pixels = reach, best_depth = 0.0;
  for (std::size_t j = 0; j < model_from_joint.size(); ++j) {
    const Vec3f place = model_from_joint[j].translation.cast<float>();
    const auto seen = project(picture.camera, picture.width, picture.height, place);
    if (!seen) continue;
    const double pixels = (seen->cast<double>() - Eigen::Vector2d(x, y)).norm();
    const double depth = (place - picture.camera.eye).norm();
    const bool nearer = pixels < best_pixels - k_one_place;
    const bool before = pixels < best_pixels + k_one_place && (!best || depth < best_depth);
    if (pixels > reach || !(nearer || before)) continue;
    best = static_cast<int>(j);
    best_pixels = pixels;
    best_depth = depth;
  }
  return best;
}

Vec3 Ring::at(double angle) const {
  const Vec3 u = axis.unitOrthogonal();
  return centre + radius * (std::cos(angle) * u + std::sin(angle) * axis.cross(u));
}

double Ring::angle_of(const Vec3& point) const {
  const Vec3 u = axis.unitOrthogonal(), away = point - centre;
  return std::atan2(away.dot(axis.cross(u)), away.dot(u));
}

double pixels_to_ring(const Picture& picture, const Ring& ring, double x, double y) {
  const Eigen::Vector2d pointer(x, y);
  const auto seen = [&](int i) {
    const Vec3 point = ring.at(2.0 * std::numbers::pi * i / k_ring_points);
    return project(picture.camera, picture.width, picture.height, point.cast<float>());
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < k_ring_points; ++i) {
    const auto from = seen(i), to = seen(i + 1);
    if (!from || !to) continue;
    const Eigen::Vector2d a = from->cast<double>(), way = to->cast<double>() - a;
    const double length = way.squaredNorm();
    const double s = length > 0.0 ? std::clamp((pointer - a).dot(way) / length, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (a + s * way - pointer).norm());
  }
  return nearest;
}

double angle_on_ring(const Ring& ring, const Ray& ray) {
  constexpr double k_edge_on = 0.15; // sine of the angle between sight and plane
  if (std::abs(ray.direction.dot(ring.axis)) > k_edge_on)
    if (const auto point = on_plane(ray, ring.centre, ring.axis)) return ring.angle_of(*point);
  double best = 0.0, nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8 * k_ring_points; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / (8 * k_ring_points);
    const double distance = (ring.at(angle) - ray.origin).cross(ray.direction).norm();
    // Front and back of the ring lie on one line of sight: the front is meant.
    const double share = distance + 1e-3 * (ring.at(angle) - ray.origin).dot(ray.direction);
    if (share < nearest) {
      nearest = share;
      best = angle;
    }
  }
  return best;
}

} // namespace tutu::app
