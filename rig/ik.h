// Inverse kinematics: the pose in which the end of a limb or of a chain is where it should be.
//
// All work on a pose `local` (parent_from_joint, joint_count entries) in place, by turning joints only: bone lengths
// stay as they are. Points and directions are in model space, m. Nothing here allocates but solve_chain.
#pragma once

#include "rig/skeleton.h"

#include <optional>
#include <span>

namespace tutu::rig {

/// How far a joint turns away from rest. The turn is split into a twist about `axis` and a swing that moves the axis
/// (`rest^-1 local = swing * twist`) [Dobrowolski 2015]; each is limited by itself. A ball joint
/// has its bone for the axis; a hinge has its hinge for the axis and no swing.
struct JointLimit {
  int joint = 0;
  Vec3 axis = Vec3::UnitY();                  ///< in the joint's frame, unit
  double most_swing = 0.0;                    ///< rad, 0 to pi
  double least_twist = 0.0, most_twist = 0.0; ///< rad, -pi <= least <= most <= pi, right-handed about the axis
};

/// The rotation nearest to `local` by that split which the limit allows; what it allows already keeps its bits.
Quat limited(const Quat& local, const Quat& rest, const JointLimit& limit);

/// Two bones: hip, knee and foot, or shoulder, elbow and hand. `lower` is somewhere below `upper`, `end` below `lower`;
/// joints between them (of twist, say) are carried along.
struct Limb {
  int upper = 0, lower = 0, end = 0;
  /// What the middle joint bends about, right-handed, in the frame of `lower`. None: as it is bent now; a limb that is
  /// straight then bends whichever way the pole says, and forgets its knee.
  std::optional<Vec3> hinge = std::nullopt;
};

/// Puts `end` on `target` and the middle joint on the side of `pole` (a point to which the knee or elbow points): law
/// of cosines in the plane of upper joint, target and pole [e.g. Holden 2017, "Simple two joint IK"]. Upper and lower
/// joint turn with that plane, so that a bent middle joint stays a hinge: only its angle changes. With the pole on the
/// line from the upper joint to the target the middle joint keeps to the side it is on. A target out of reach, or too
/// near, leaves the limb straight (or folded) towards it. `end` keeps its rotation to its parent.
///
/// Limits are applied afterwards: where they bite, the target may be missed although another bend would reach it.
/// Returns the distance from `end` to `target`, m: 0 within rounding (1e-12 of the limb) when it is in reach.
double solve_limb(const Skeleton& skeleton, std::span<Transform> local, const Limb& limb, const Vec3& target,
                  const Vec3& pole, std::span<const JointLimit> limits = {});

/// A foot that stays where it stands while the body moves.
struct FootPin {
  Limb limb;
  Transform model_from_foot;
};

/// Pins a foot to the ground under where it is: as high over `ground_height` (m, model space) as at rest over 0, its
/// sole as flat as at rest, heading as now.
FootPin pin_to_ground(const Skeleton& skeleton, std::span<const Transform> local, const Limb& limb,
                      double ground_height);

/// Bends the leg so that the pinned foot is where it was, turned as it was; the knee points on as it does now, a
/// straight leg's to `pole`. Returns how far the foot is from its pin, m: above 0 when the leg is too short for it.
double hold_foot(const Skeleton& skeleton, std::span<Transform> local, const FootPin& pin, const Vec3& pole,
                 std::span<const JointLimit> limits = {});

struct ChainOptions {
  double tolerance = 1e-7;   ///< m: an end this near has arrived. Far below what is seen, far above rounding
  int most_iterations = 200; ///< near full stretch the method is slow
  Vec3 bend = Vec3::UnitZ(); ///< the way a chain bends that is straight towards its target; any length
};

/// Puts the end of a chain of any length on `target` by FABRIK [Aristidou and Lasenby 2011, algorithm 1]: `chain` holds
/// joints from root to end, each somewhere below the one before; all but the last turn, each by the smallest turn that
/// does it. With limits by cyclic coordinate descent [Wang and Chen 1991] instead, each joint brought within its limits
/// as it turns: FABRIK gets stuck between a limit and its own next step. A target out of reach leaves the chain
/// straight towards it (as far as limits let it). Of all iterations the best is kept. Returns the distance from end to
/// target, m.
double solve_chain(const Skeleton& skeleton, std::span<Transform> local, std::span<const int> chain, const Vec3& target,
                   std::span<const JointLimit> limits = {}, const ChainOptions& options = {});

} // namespace tutu::rig
