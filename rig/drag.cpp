#include "rig/drag.h"

namespace tutu::rig {
namespace {

/// model_from_parent of a joint. No parent: model space itself.
Transform model_above(const Skeleton& skeleton, std::span<const Transform> local, int joint) {
  const int parent = skeleton.parents[joint];
  return parent == k_no_parent ? Transform() : model_of_joint(skeleton, local, parent);
}

/// R(theta, n): the turn (model space) about the parent's origin that takes the bone to the target.
Quat bone_turn(const Transform& model_from_parent, const Vec3& joint_in_parent, const Vec3& target) {
  const Vec3 centre = model_from_parent.translation;
  const Vec3 bone = model_from_parent.rotation * joint_in_parent;
  return rotation_between(bone, nearest_on_bone_sphere(centre, centre + bone, target) - centre);
}

/// Turns this small (rad) are the rounding of a target that lies on the bone already; the pose keeps its bits.
bool is_no_turn(const Quat& turn) {
  constexpr double k_least_turn = 1e-13;
  return 2.0 * turn.vec().norm() < k_least_turn;
}

} // namespace

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
  const Transform model_from_grandparent = model_above(skeleton, local, parent);
  const Quat turn = bone_turn(model_from_grandparent * local[parent], local[joint].translation, target);
  if (is_no_turn(turn)) return;

  const Quat& grandparent = model_from_grandparent.rotation;
  Quat& rotation = local[parent].rotation;
  rotation = (grandparent.conjugate() * turn * grandparent * rotation).normalized(); // no drift over many drags
}

void drag_joint_alone(const Skeleton& skeleton, std::span<Transform> local, int joint, const Vec3& target) {
  if (skeleton.parents[joint] == k_no_parent) {
    local[joint].translation = target;
    return;
  }
  const Transform model_from_parent = model_above(skeleton, local, joint);
  const double length = local[joint].translation.norm();
  const Quat turn = bone_turn(model_from_parent, local[joint].translation, target);
  if (is_no_turn(turn)) return;

  const Quat pseudo_joint = model_from_parent.rotation.conjugate() * turn * model_from_parent.rotation;
  local[joint].translation = length * (pseudo_joint * local[joint].translation).normalized(); // no drift either
  local[joint].rotation = (pseudo_joint * local[joint].rotation).normalized();
}

} // namespace tutu::rig
