// Limits, and limbs of two bones. Chains are in ik_chain.cpp.
#include "rig/ik.h"

#include "rig/detail/ik_chain.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tutu::rig {
namespace {

using ik_detail::apply_limit;
using ik_detail::turn_in_model;

/// The rotation that takes the right-handed frame (a, normal) to (b, other normal); each pair is orthonormal.
Quat frame_to_frame(const Vec3& a, const Vec3& a_normal, const Vec3& b, const Vec3& b_normal) {
  Eigen::Matrix3d from, to;
  from << a, a_normal, a.cross(a_normal);
  to << b, b_normal, b.cross(b_normal);
  return Quat(Eigen::Matrix3d(to * from.transpose())).normalized();
}

/// What of `v` is perpendicular to the unit vector `along`, unit; zero when there is nothing beyond rounding.
Vec3 unit_across(const Vec3& v, const Vec3& along) {
  constexpr double k_least_share = 1e-7; // sine of the angle below which a side is noise
  const Vec3 across = v - v.dot(along) * along;
  const double length = across.norm();
  return length > k_least_share * v.norm() ? Vec3(across / length) : Vec3(Vec3::Zero());
}

/// Turns the bone `from` -> `to` of a limb so that what `hinge` was becomes `normal`; by the smallest turn where it has
/// no hinge.
Quat bone_turn(const Vec3& from, const Vec3& to, const Vec3& hinge, const Vec3& normal) {
  const Vec3 old_normal = unit_across(hinge, from.normalized());
  if (old_normal.isZero(0.0)) return rotation_between(from, to);
  return frame_to_frame(from.normalized(), old_normal, to.normalized(), normal);
}

} // namespace

Quat limited(const Quat& local, const Quat& rest, const JointLimit& limit) {
  Quat away = rest.conjugate() * local;
  if (away.w() < 0.0) away.coeffs() = -away.coeffs();
  // The twist is the part of the quaternion along the axis; half a turn of swing leaves none to be told.
  const double along = away.vec().dot(limit.axis), length = std::hypot(away.w(), along);
  const double twist = length > 0.0 ? 2.0 * std::atan2(along, away.w()) : 0.0;
  const Quat untwisted = away * Quat(Eigen::AngleAxisd(-twist, limit.axis));
  const double swing = 2.0 * std::atan2(untwisted.vec().norm(), std::abs(untwisted.w()));

  const double allowed_twist = std::clamp(twist, limit.least_twist, limit.most_twist);
  const double allowed_swing = std::min(swing, limit.most_swing);
  // What a hinge was set to comes back with rounding in it; that is no swing.
  constexpr double k_rounding = 1e-12; // rad
  if (allowed_twist == twist && swing <= allowed_swing + k_rounding) return local;
  Quat kept = Quat::Identity();
  if (allowed_swing > 0.0) {
    const Vec3 axis = (untwisted.w() < 0.0 ? -untwisted.vec() : Vec3(untwisted.vec())).normalized();
    kept = Quat(Eigen::AngleAxisd(allowed_swing, axis));
  }
  return (rest * kept * Quat(Eigen::AngleAxisd(allowed_twist, limit.axis))).normalized();
}

double solve_limb(const Skeleton& skeleton, std::span<Transform> local, const Limb& limb, const Vec3& target,
                  const Vec3& pole, std::span<const JointLimit> limits) {
  assert(limb.upper < limb.lower && limb.lower < limb.end);
  const Vec3 a = model_of_joint(skeleton, local, limb.upper).translation;
  const Vec3 b = model_of_joint(skeleton, local, limb.lower).translation;
  const Vec3 c = model_of_joint(skeleton, local, limb.end).translation;
  const double upper = (b - a).norm(), lower = (c - b).norm(), wanted = (target - a).norm();
  if (!(upper > 0.0) || !(lower > 0.0)) return (c - target).norm(); // bones without length turn nothing

  const Vec3 old_along = (b - a) / upper;
  // A target on the upper joint itself has no direction; the limb folds where it points.
  const Vec3 along =
      wanted > 0.0 ? Vec3((target - a) / wanted) : Vec3((c - a).norm() > 0.0 ? (c - a).normalized() : old_along);
  Vec3 side = unit_across(pole - a, along);
  if (side.isZero(0.0)) side = unit_across(b - a, along);
  if (side.isZero(0.0)) side = along.unitOrthogonal();

  const double reach = std::clamp(wanted, std::abs(upper - lower), upper + lower);
  // Law of cosines at the upper joint; limbs folded onto themselves (reach 0) are perpendicular to `along`.
  const double cosine =
      reach > 0.0 ? std::clamp((upper * upper + reach * reach - lower * lower) / (2.0 * upper * reach), -1.0, 1.0)
                  : 0.0;
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const Vec3 knee = a + upper * (cosine * along + sine * side), end = a + reach * along;

  const Vec3 bent = unit_across(c - b, old_along);
  const Vec3 hinge = limb.hinge ? Vec3(model_of_joint(skeleton, local, limb.lower).rotation * *limb.hinge)
                                : Vec3(old_along.cross(bent));
  const Vec3 normal = side.cross(along); // the limb leaves to `side` and comes back: so it turns about this
  const Quat turn_upper = bone_turn(b - a, knee - a, hinge, normal);
  turn_in_model(skeleton, local, limb.upper, turn_upper);
  turn_in_model(skeleton, local, limb.lower, bone_turn(turn_upper * (c - b), end - knee, turn_upper * hinge, normal));
  for (const int joint : {limb.upper, limb.lower}) apply_limit(skeleton, local, joint, limits);
  return (model_of_joint(skeleton, local, limb.end).translation - target).norm();
}

FootPin pin_to_ground(const Skeleton& skeleton, std::span<const Transform> local, const Limb& limb,
                      double ground_height) {
  const Transform now = model_of_joint(skeleton, local, limb.end),
                  rest = model_of_joint(skeleton, skeleton.rest_local, limb.end);
  // The heading is the turn about +Y nearest to the whole turn from rest: the twist about Y.
  const Quat away = now.rotation * rest.rotation.conjugate();
  const Quat heading =
      std::hypot(away.w(), away.y()) > 0.0 ? Quat(away.w(), 0.0, away.y(), 0.0).normalized() : Quat::Identity();
  FootPin pin{limb, {heading * rest.rotation, now.translation}};
  pin.model_from_foot.translation.y() = ground_height + rest.translation.y();
  return pin;
}

double hold_foot(const Skeleton& skeleton, std::span<Transform> local, const FootPin& pin, const Vec3& pole,
                 std::span<const JointLimit> limits) {
  const Limb& limb = pin.limb;
  const Vec3 hip = model_of_joint(skeleton, local, limb.upper).translation;
  const Vec3 knee = model_of_joint(skeleton, local, limb.lower).translation;
  const Vec3 foot = model_of_joint(skeleton, local, limb.end).translation;
  const Vec3 side = unit_across(knee - hip, (foot - hip).normalized());
  const Vec3& target = pin.model_from_foot.translation;
  const double error = solve_limb(skeleton, local, limb, target, side.isZero(0.0) ? pole : Vec3(knee + side), limits);
  const int parent = skeleton.parents[limb.end];
  local[limb.end].rotation =
      (model_of_joint(skeleton, local, parent).rotation.conjugate() * pin.model_from_foot.rotation).normalized();
  return error;
}

} // namespace tutu::rig
