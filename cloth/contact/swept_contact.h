// Contact by time of impact in plain double, for steps in which the contact at the end alone could let cloth through.
#pragma once

#include "proxies/contact.h"
#include "proxies/motion/sweep.h"
#include "proxies/shapes.h"

#include <array>
#include <optional>

namespace tutu::cloth {

/// A collider's way through a substep, and what the cloth keeps from it.
struct SweptCollider {
  proxies::Capsule start, end; ///< world
  Vec3 spin = Vec3::Zero();    ///< rotation vector in the substep, rad
  double offset = 0.0;         ///< m
};

/// A point of the cloth, at the weights of its corners, that has gone through: it is to move by `passed` (m, > 0) along
/// the normal, to the side that it touched. Then it is outside the plane through the point of touch, moved on with the
/// surface; contacts at the end of the substep go on from there.
struct SweptContact {
  proxies::Contact touch; ///< with cloth and collider where they were when they touched
  std::array<double, 3> weights = {1.0, 0.0, 0.0};
  double passed = 0.0;
  double time = 0.0; ///< of the touch, in [0, 1] of the substep
};

/// Nothing for what did not touch, for what began the substep inside the collider itself (it is worked out slowly), and
/// for what the contact at the end will bring out the way it came in. Of a triangle whose contact is where the axis
/// crosses it, no side is known to be the right one: nothing either.
std::optional<SweptContact> swept_contact(const Vec3& from, const Vec3& to, const SweptCollider& collider);
std::optional<SweptContact> swept_contact(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to,
                                          const SweptCollider& collider);

} // namespace tutu::cloth
