#include "proxies/detail/query_guard.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace tutu::proxies {
namespace {

constexpr double k_unit_tolerance = 1e-9; // of a plane's normal; a distance is wrong by this share

std::string exactly(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string exactly(const Vec3& v) {
  return '{' + exactly(v.x()) + ", " + exactly(v.y()) + ", " + exactly(v.z()) + '}';
}

[[noreturn]] void refuse(const std::string& found, const char* expected) {
  throw std::invalid_argument("collision query: found " + found + ", expected " + expected);
}

/// m. FCL's tree multiplies coordinates and crashes when they overflow; far below that, and beyond every scene.
constexpr double k_farthest = 1e12;
constexpr const char* k_finite_point = "finite coordinates within +-1e12 m";

bool in_range(double value) { return std::abs(value) <= k_farthest; } // false for what is no number
bool in_range(const Vec3& v) { return in_range(v.x()) && in_range(v.y()) && in_range(v.z()); }

} // namespace

void require_usable(const Capsule& capsule, int index) {
  if (in_range(capsule.a) && in_range(capsule.b) && in_range(capsule.radius) && in_range(capsule.taper) &&
      capsule.narrowest() > 0.0)
    return;
  refuse("collider " + std::to_string(index) + " Capsule{" + exactly(capsule.a) + ", " + exactly(capsule.b) + ", " +
             exactly(capsule.radius) + ", " + exactly(capsule.taper) + '}',
         "end points within +-1e12 m and radii above 0");
}

void require_usable(const std::optional<Plane>& ground) {
  if (!ground) return;
  const bool is_unit = std::abs(ground->normal.norm() - 1.0) <= k_unit_tolerance;
  if (is_unit && in_range(ground->offset)) return;
  refuse("ground Plane{" + exactly(ground->normal) + ", " + exactly(ground->offset) + '}',
         "a unit normal and a finite offset");
}

void require_usable(const Vec3& point) {
  if (!in_range(point)) refuse("point " + exactly(point), k_finite_point);
}

void require_usable(std::span<const Vec3> points, double reach) {
  if (!(in_range(reach) && reach >= 0.0)) refuse("reach " + exactly(reach), "a length from 0 to 1e12 m");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!in_range(points[i])) refuse("point " + std::to_string(i) + ' ' + exactly(points[i]), k_finite_point);
}

void require_usable(std::span<const Box> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[i];
    if (in_range(box.min()) && in_range(box.max()) && !box.isEmpty()) continue;
    refuse("box " + std::to_string(i) + " Box{" + exactly(box.min()) + ", " + exactly(box.max()) + '}',
           "corners within +-1e12 m, the lower one first");
  }
}

} // namespace tutu::proxies
