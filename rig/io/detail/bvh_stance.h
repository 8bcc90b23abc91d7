// Private to read_bvh(): which way is up in a take, and how its actor stands.
//
// A BVH file says neither its axes nor where the floor is, and the pose with all rotations zero need not stand. The
// skeleton's names tell legs and head where they are usual ones (rig/body_regions.h); legs at rest and legs in motion
// then tell which way is up, and the height of the hips where the two differ.
#pragma once

#include "rig/io/detail/bvh_hierarchy.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::rig::bvh_detail {

using Pose = std::vector<Transform>; ///< [joint] parent_from_joint

/// What tells of a skeleton how it stands. Indices of joints.
struct Landmarks {
  struct Leg {
    int top, foot;
  };
  std::vector<Leg> legs;
  std::optional<int> head;

  bool known() const { return !legs.empty(); }
};
Landmarks find_landmarks(const Skeleton& skeleton);

/// Whether up is +Z in the file: where it is not, +Y is taken for it. `samples`: poses from all of the take, at least
/// one. `rest`: a pose that is known to stand, if one is. Careful: where signs are weak or contradict, +Y.
bool is_z_up(const Hierarchy& hierarchy, const Landmarks& marks, std::span<const Pose> samples, const Pose* rest);

/// (x, y, z) -> (x, z, -y), of a transform's both sides; exact.
Vec3 turned_to_y_up(const Vec3& v);
Transform turned_to_y_up(const Transform& t);

/// How the actor stands, with +Y up; the file's unit.
struct Standing {
  Pose rest;                         ///< feet as high as they are where the actor stands in the motion
  double raise = 0.0;                ///< to be added to the root's height in all frames, so that the floor is at 0
  std::optional<std::size_t> sample; ///< whose pose the rest pose is, where all rotations zero are no stance
  std::vector<std::string> notes;
};
/// The rest pose: all rotations zero; turned to stand upright where that lies; the most upright of the samples where it
/// is no stance at all.
Standing find_standing(const Hierarchy& hierarchy, const Landmarks& marks, std::span<const Pose> samples);

/// Lowest and highest point of a pose, ends of bones included, along +Y.
struct Extent {
  double lowest, highest;
};
Extent extent_of(const Hierarchy& hierarchy, const Pose& pose);

} // namespace tutu::rig::bvh_detail
