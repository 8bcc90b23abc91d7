// Posing by hand: what moving one joint does to the pose. Pure functions, shared by the editor and the tests.
#pragma once

#include "rig/skeleton.h"

#include <span>

namespace tutu::rig {

/// The point of the bone's sphere nearest to `target`: the sphere about `centre` through `joint`. With the target at
/// the centre every point is nearest, and the joint stays where it is. All in one space; m.
Vec3 nearest_on_bone_sphere(const Vec3& centre, const Vec3& joint, const Vec3& target);

/// Drags `joint` to `target` (model space, m) in the pose `local` (parent_from_joint), in place.
///
/// A joint with a parent goes to the nearest point of its bone's sphere: its parent turns by
///   R_parent <- (R_gp^-1 R(theta, n) R_gp) R_parent
/// where R_gp is the rotation of the grandparent in model space and R(theta, n) the smallest rotation that takes the
/// bone's direction to its new one [INF585 report 2021, pose editor]. All siblings turn along. A target opposite to the
/// bone turns half round about some perpendicular axis; a zero drag changes nothing; a bone without length cannot be
/// turned and changes nothing. A root joint is translated. Bone lengths are kept.
void drag_joint(const Skeleton& skeleton, std::span<Transform> local, int joint, const Vec3& target);

/// Drags `joint` to `target` as drag_joint does, but turns the one bone only: as if a pseudo-joint stood at the
/// parent's origin, with `joint` its only child. The turn goes into the joint's own transform,
///   local <- (R_parent^-1 R(theta, n) R_parent) local,
/// translation and rotation alike, so that parent and siblings keep their bits. A pose made so needs its translations
/// kept with it.
void drag_joint_alone(const Skeleton& skeleton, std::span<Transform> local, int joint, const Vec3& target);

} // namespace tutu::rig
