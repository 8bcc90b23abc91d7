// Private to read_bvh(): what a BVH file says before its motion.
#pragma once

#include "rig/io/detail/bvh_words.h"
#include "rig/skeleton.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tutu::rig::bvh_detail {

enum class Channel : std::uint8_t { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

/// Lengths in the file's unit, axes as the file has them.
struct Hierarchy {
  struct EndSite {
    int parent;
    Vec3 offset;
  };
  Skeleton skeleton;                          ///< of the first root; rest_local: the offsets; names are unique
  std::vector<std::vector<Channel>> channels; ///< [joint]
  std::vector<EndSite> ends;
  int channels_besides = 0; ///< of the other roots; they follow in each frame
  std::vector<std::string> notes;

  int own_channels() const;
  int all_channels() const { return own_channels() + channels_besides; }
};

/// Reads up to MOTION, which is taken. Several roots: the first is kept, the others become a note. Throws InputError
/// with file and line.
Hierarchy read_hierarchy(Words& words);

} // namespace tutu::rig::bvh_detail
