#include "proxies/query_guard.h"

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

constexpr const char* k_finite_point = "finite coordinates";

} // namespace

void require_usable(const Capsule& capsule, int index) {
  if (is_finite(capsule.a) && is_finite(capsule.b) && std::isfinite(capsule.radius) && capsule.radius > 0.0) return;
  refuse("collider " + std::to_string(index) + " Capsule{" + exactly(capsule.a) + ", " + exactly(capsule.b) + ", " +
             exactly(capsule.radius) + '}',
         "finite end points and a radius above 0");
}

void require_usable(const std::optional<Plane>& ground) {
  if (!ground) return;
  const bool is_unit = std::abs(ground->normal.norm() - 1.0) <= k_unit_tolerance;
  if (is_unit && std::isfinite(ground->offset)) return;
  refuse("ground Plane{" + exactly(ground->normal) + ", " + exactly(ground->offset) + '}',
         "a unit normal and a finite offset");
}

void require_usable(const Vec3& point) {
  if (!is_finite(point)) refuse("point " + exactly(point), k_finite_point);
}

void require_usable(std::span<const Vec3> points, double reach) {
  if (!(std::isfinite(reach) && reach >= 0.0)) refuse("reach " + exactly(reach), "a finite length, 0 or above");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_finite(points[i])) refuse("point " + std::to_string(i) + ' ' + exactly(points[i]), k_finite_point);
}

} // namespace tutu::proxies
