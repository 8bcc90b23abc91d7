#include "rig/drag.h"

namespace tutu::rig {

Vec3 nearest_on_bone_sphere(const Vec3& centre, const Vec3& joint, const Vec3& target) {
  const Vec3 away = target - centre;
  const double distance = away.norm();
  if (!(distance > 0.0)) return joint;
  return centre + away * ((joint - centre).norm() / distance);
}

void drag_joint(const Skeleton& skeleton, std::span<Transform> local, int joint, const Vec3& target) {
  const int parent = skeleton.parents[joint];
  if (parent == k_no_parent) {
    local[joint].translation = target;
    return;
  }
  // model_from_grandparent, collected on the way up. No grandparent: model space itself.
  Transform model_from_grandparent;
  for (int above = skeleton.parents[parent]; above != k_no_parent; above = skeleton.parents[above])
    model_from_grandparent = local[above] * model_from_grandparent;
  const Transform model_from_parent = model_from_grandparent * local[parent];

  const Vec3 centre = model_from_parent.translation;
  const Vec3 bone = model_from_parent.rotation * local[joint].translation;
  const Quat turn = rotation_between(bone, nearest_on_bone_sphere(centre, centre + bone, target) - centre);
  // Turns this small (rad) are the rounding of a target that lies on the bone already; leave the pose its bits.
  constexpr double k_least_turn = 1e-13;
  if (2.0 * turn.vec().norm() < k_least_turn) return;

  const Quat& grandparent = model_from_grandparent.rotation;
  Quat& rotation = local[parent].rotation;
  rotation = (grandparent.conjugate() * turn * grandparent * rotation).normalized(); // no drift over many drags
}

} // namespace tutu::rig
