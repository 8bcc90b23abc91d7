// Motion capture as BVH files (Biovision hierarchy) hold it: a skeleton of its own, and a pose a frame.
#pragma once

#include "rig/clip.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tutu::rig {

/// Which part of a take to read, and what its skeleton rests in.
struct BvhOptions {
  /// The frame that is the rest pose, where the actor stands as characters do: many takes begin with a T-pose. None:
  /// all rotations zero, stood up where the actor then lies, the feet as high as they are in the motion where it
  /// stands; an upright frame where the actor then has no stance at all.
  std::optional<int> rest_frame;
  double from = 0.0;        ///< s from the first frame: what is before is left out, time begins at 0 there
  std::optional<double> to; ///< s; none = the end
};

struct Mocap {
  Skeleton skeleton;
  Clip clip;
  std::vector<std::string> notes; ///< what was decided that the file does not say, a clause each
};

/// A BVH file has no unit: it is scaled so that the actor's skeleton at rest, ends of bones included, is this high, m.
/// On a character its travel is scaled anew, by rest heights (retarget).
inline constexpr double k_bvh_stature = 1.7;

/// Reads a take. Rotations are the product of the channels in their order, left to right, positions take the place of
/// the offset [Meredith and Maddock 2001]. Right-handed, +Y up; a file with +Z up, as its legs and the height of its
/// hips tell, is turned: (x, y, z) -> (x, z, -y). Of several roots the first is read. Where feet at rest and in motion
/// tell that the floor is not at height 0, it is put there. Each of these is noted. Throws InputError with file and
/// line on all that is malformed, on rest frames and times that are not there.
Mocap read_bvh(const std::filesystem::path& file, const BvhOptions& options = {});

/// Calls joints by the names of another skeleton's, so that retarget() pairs them. A joint without a counterpart (none)
/// gets its name in brackets, which pairs with nothing. Throws InputError (naming `file`) on a joint the skeleton lacks
/// and on a name that is then there twice.
void rename_joints(Skeleton& skeleton, const std::map<std::string, std::optional<std::string>>& names,
                   const std::string& file);

} // namespace tutu::rig
