#include "proxies/signed_distance.h"

#include <algorithm>
#include <cmath>

namespace tutu::proxies {

Vec3 normal_on_axis(const Capsule& capsule) {
  const Vec3 axis = capsule.b - capsule.a;
  const double length = axis.norm();
  if (length <= k_on_axis) return Vec3::UnitY();
  const Vec3 u = axis / length;
  // Y - (Y.u) u, with 1 - u_y^2 written so that it does not cancel; its length is the sine of the angle to +Y.
  const double sine = std::hypot(u.x(), u.z());
  if (sine <= k_vertical) return Vec3::UnitX();
  return Vec3(-u.y() * u.x() / sine, sine, -u.y() * u.z() / sine);
}

Contact signed_distance(const Vec3& point, const Capsule& capsule) {
  const Vec3 axis = capsule.b - capsule.a, from_a = point - capsule.a;
  const double length_squared = axis.squaredNorm();
  const double t = length_squared > 0.0 ? std::clamp(from_a.dot(axis) / length_squared, 0.0, 1.0) : 0.0;
  const Vec3 nearest = capsule.a + t * axis;
  const Vec3 away = point - nearest;
  const double length = away.norm();
  const double distance = length - capsule.radius;
  if (length <= k_on_axis) {
    const Vec3 normal = normal_on_axis(capsule);
    return {distance, normal, point - distance * normal};
  }
  const Vec3 normal = away / length;
  return {distance, normal, nearest + capsule.radius * normal};
}

Contact signed_distance(const Vec3& point, const Plane& plane) {
  const double distance = plane.normal.dot(point) - plane.offset;
  return {distance, plane.normal, point - distance * plane.normal};
}

} // namespace tutu::proxies
