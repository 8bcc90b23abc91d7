// What limbs and chains share (rig/ik*.cpp): single joints of a pose, in model space.
#pragma once

#include "rig/ik.h"

namespace tutu::rig::ik_detail {

/// Turns a joint and all below it about its origin by `turn` (model space).
inline void turn_in_model(const Skeleton& skeleton, std::span<Transform> local, int joint, const Quat& turn) {
  const int parent = skeleton.parents[joint];
  const Quat above = parent == k_no_parent ? Quat::Identity() : model_of_joint(skeleton, local, parent).rotation;
  local[joint].rotation = (above.conjugate() * turn * above * local[joint].rotation).normalized();
}

/// Brings a joint within its limits, if it has any.
inline void apply_limit(const Skeleton& skeleton, std::span<Transform> local, int joint,
                        std::span<const JointLimit> limits) {
  for (const JointLimit& limit : limits)
    if (limit.joint == joint)
      local[joint].rotation = limited(local[joint].rotation, skeleton.rest_local[joint].rotation, limit);
}

} // namespace tutu::rig::ik_detail
