#include "rig/math.h"

#include <cmath>
#include <numbers>

namespace tutu {

Quat nlerp(const Quat& a, const Quat& b, double s) {
  const double side = a.dot(b) < 0.0 ? -1.0 : 1.0;
  Quat blend;
  blend.coeffs() = (1.0 - s) * a.coeffs() + (side * s) * b.coeffs();
  // On the shorter arc the blend is at least sqrt(1/2) long, so it can always be normalised.
  blend.normalize();
  return blend;
}

Transform interpolate(const Transform& a, const Transform& b, double s) {
  return {nlerp(a.rotation, b.rotation, s), (1.0 - s) * a.translation + s * b.translation};
}

Quat rotation_between(const Vec3& from, const Vec3& to) {
  const double lengths = from.norm() * to.norm();
  if (!(lengths > 0.0)) return Quat::Identity();
  const double cosine = from.dot(to) / lengths;
  if (cosine < -1.0 + 1e-12) {
    // Half a turn about any perpendicular axis: take the one farthest from `from`'s largest component.
    Vec3::Index smallest = 0;
    from.cwiseAbs().minCoeff(&smallest);
    const Vec3 axis = from.cross(Vec3::Unit(smallest)).normalized();
    return Quat(Eigen::AngleAxisd(std::numbers::pi, axis));
  }
  // Half-angle form: (|a||b| + a.b, a x b) is 2|a||b| cos(theta/2) times the wanted quaternion.
  const Vec3 axis = from.cross(to) / lengths;
  return Quat(1.0 + cosine, axis.x(), axis.y(), axis.z()).normalized();
}

} // namespace tutu
