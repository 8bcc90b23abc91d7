// A pose seen in a mirror that stands in x = 0, between her left and her right.
#pragma once

#include "rig/strong_poses.h"
#include "src/view/pose/edit_state.h"

namespace tutu::app {

/// [joint] the joint on the other side, by name; itself where there is none.
std::vector<int> other_sides(const rig::Skeleton& skeleton);

/// Left and right exchanged: each joint leaves its rest pose as its counterpart did, seen in the mirror. A skeleton
/// whose rest pose is not symmetric keeps its own bone lengths. Twice is the same pose within rounding.
Pose mirrored(const rig::Skeleton& skeleton, std::span<const Transform> pose);

/// Only the joints on the side opposite to `from` change: they do what those of `from` do.
Pose copied_across(const rig::Skeleton& skeleton, std::span<const Transform> pose, rig::Side from);

} // namespace tutu::app
