#include "proxies/distance/signed_distance.h"

#include <cmath>

namespace tutu::proxies {

double cone_sine(const Capsule& capsule) {
  if (capsule.taper == 0.0) return 0.0;
  const double length = (capsule.b - capsule.a).norm();
  return std::abs(capsule.taper) < length ? capsule.taper / length : std::copysign(1.0, capsule.taper);
}

Vec3 normal_on_axis(const Capsule& capsule) {
  const Vec3 axis = capsule.b - capsule.a;
  const double length = axis.norm();
  if (length <= k_on_axis) return Vec3::UnitY();
  const Vec3 u = axis / length;
  // Y - (Y.u) u, with 1 - u_y^2 written so that it does not cancel; its length is the sine of the angle to +Y.
  const double sine = std::hypot(u.x(), u.z());
  const Vec3 across =
      sine <= k_vertical ? Vec3(Vec3::UnitX()) : Vec3(-u.y() * u.x() / sine, sine, -u.y() * u.z() / sine);
  if (capsule.taper == 0.0) return across;
  const double lean = cone_sine(capsule);
  return std::sqrt(1.0 - lean * lean) * across - lean * u;
}

Contact signed_distance(const Vec3& point, const Capsule& capsule) {
  const double t = nearest_on_axis(point, capsule), radius = capsule.radius_at(t);
  const Vec3 nearest = capsule.a + t * (capsule.b - capsule.a);
  const Vec3 away = point - nearest;
  const double length = away.norm();
  const double distance = length - radius;
  if (length <= k_on_axis) {
    const Vec3 normal = normal_on_axis(capsule);
    return {distance, normal, point - distance * normal};
  }
  const Vec3 normal = away / length;
  return {distance, normal, nearest + radius * normal};
}

Contact signed_distance(const Vec3& point, const Plane& plane) {
  const double distance = PlainForms::height(plane.normal, plane.offset, point);
  return {distance, plane.normal, point - distance * plane.normal};
}

} // namespace tutu::proxies
