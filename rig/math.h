// The few mathematical types everything else is written in.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tutu {

/// No number of a file may be larger, in any unit: no scene is, and products of a few stay far from overflow.
inline constexpr double k_largest_number = 1e9;

using Vec3 = Eigen::Vector3d;  ///< metres unless said otherwise
using Vec3f = Eigen::Vector3f; ///< single precision, for meshes and drawing
using Quat = Eigen::Quaterniond;

/// A rigid motion: x -> rotation * x + translation. The rotation is a unit quaternion.
/// Named by the spaces it joins: `model_from_joint * point_in_joint = point_in_model`.
struct Transform {
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 operator*(const Vec3& point) const { return rotation * point + translation; }
  Transform operator*(const Transform& inner) const {
    return {rotation * inner.rotation, rotation * inner.translation + translation};
  }
  Transform inverse() const {
    const Quat back = rotation.conjugate();
    return {back, -(back * translation)};
  }
};

/// Normalised linear interpolation along the shorter arc; `s` in [0, 1]. Both inputs are unit.
/// At exactly opposite rotations (dot product -0 of a half turn apart) the arc is not unique and `a`'s side wins.
Quat nlerp(const Quat& a, const Quat& b, double s);

/// LERP of the translations, nlerp of the rotations.
Transform interpolate(const Transform& a, const Transform& b, double s);

/// The smallest rotation that takes the direction of `from` to that of `to` (neither needs unit length).
/// Opposite directions turn by pi about an axis perpendicular to `from`; a zero vector gives the identity.
Quat rotation_between(const Vec3& from, const Vec3& to);

/// m2.
inline double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a).norm(); }

inline bool is_finite(const Vec3& v) { return v.allFinite(); }
/// Every coordinate within +-k_largest_number; false for what is no number.
inline bool is_in_bounds(const Vec3& v) { return (v.array().abs() <= k_largest_number).all(); }
inline bool is_finite(const Transform& t) { return t.rotation.coeffs().allFinite() && t.translation.allFinite(); }

} // namespace tutu
