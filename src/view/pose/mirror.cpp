#include "src/view/pose/mirror.h"

namespace tutu::app {

std::vector<int> other_sides(const rig::Skeleton& skeleton) {
  std::vector<int> other(skeleton.names.size());
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const std::string name = rig::name_on_other_side(skeleton.names[j]);
    const auto found = name.empty() ? std::nullopt : skeleton.find(name);
    other[j] = found && skeleton.find(rig::name_on_other_side(skeleton.names[*found])) == j ? *found : j;
  }
  return other;
}

Pose mirrored(const rig::Skeleton& skeleton, std::span<const Transform> pose) {
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  const std::vector<int> other = other_sides(skeleton);
  const auto axes_above = [&](int joint) {
    const int parent = skeleton.parents[joint];
    return parent == rig::k_no_parent ? Quat::Identity() : rest[parent].rotation;
  };
  Pose result(pose.begin(), pose.end());
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int from = other[j];
    const Transform &to_rest = skeleton.rest_local[j], &from_rest = skeleton.rest_local[from];
    // The turn away from rest, in the axes of model space at rest. In the mirror an axis keeps its x and turns the
    // other way about, so y and z of the quaternion change sign.
    const Quat &to_axes = rest[j].rotation, &from_axes = rest[from].rotation;
    if (pose[from].rotation.coeffs() == from_rest.rotation.coeffs()) {
      result[j].rotation = to_rest.rotation;
    } else {
      Quat turn = from_axes * (from_rest.rotation.conjugate() * pose[from].rotation) * from_axes.conjugate();
      turn.y() = -turn.y();
      turn.z() = -turn.z();
      result[j].rotation = (to_rest.rotation * (to_axes.conjugate() * turn * to_axes)).normalized();
    }
    Vec3 shift = axes_above(from) * (pose[from].translation - from_rest.translation);
    shift.x() = -shift.x();
    result[j].translation = to_rest.translation + axes_above(j).conjugate() * shift;
  }
  return result;
}

Pose copied_across(const rig::Skeleton& skeleton, std::span<const Transform> pose, rig::Side from) {
  const std::vector<int> other = other_sides(skeleton);
  const Pose seen = mirrored(skeleton, pose);
  Pose result(pose.begin(), pose.end());
  for (int j = 0; j < skeleton.joint_count(); ++j)
    if (other[j] != j && rig::side_of(skeleton.names[other[j]]) == from) result[j] = seen[j];
  return result;
}

} // namespace tutu::app
