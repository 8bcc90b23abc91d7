// A character from a file, with the animations it brings.
#pragma once

#include "rig/channel_clip.h"
#include "rig/character.h"
#include "rig/length_unit.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig {

/// What the importer found and what it did about it, for `tutu inspect` and for warnings.
struct ImportReport {
  std::string format;         ///< "Collada", "glTF 2.0 binary", ...
  double metres_per_unit = 1; ///< applied to every length of the file
  std::string up_axis;        ///< "Y" or "Z" as found; the result is +Y up
  double height = 0;          ///< of the skinned body at rest, m
  int file_meshes = 0, file_skeletons = 0;
  int file_vertices = 0; ///< before welding
  int joints_without_weight = 0;
  int largest_influences = 0;     ///< of any vertex in the file
  int cut_vertices = 0;           ///< vertices that lost influences beyond the limit
  double largest_cut = 0;         ///< largest weight share a vertex lost
  std::vector<std::string> notes; ///< one sentence each: joints renamed, meshes left out, scale removed, ...
};

/// Where a character rests: what it is dressed, measured and retargeted in.
enum class RestPose {
  bind, ///< where its skin was bound to the joints
  node  ///< where the file's nodes stand, which may be in the middle of a leap
};
inline constexpr std::array<std::string_view, 2> k_rest_pose_names{"bind", "node"};
/// Of one of k_rest_pose_names.
RestPose rest_pose_named(std::string_view name);

struct ImportOptions {
  int max_influences = 4; ///< 4 or 8
  RestPose rest = RestPose::bind;
  std::optional<double> height = std::nullopt;          ///< m: the body is made this high, whatever the file's unit
  std::optional<double> metres_per_unit = std::nullopt; ///< in place of what the file says; not beside a height
};

struct Import {
  Character character;
  std::vector<ChannelClip> clips; ///< animations of the file, on the joints of `character`, in m
  ImportReport report;
};

/// Reads Collada, FBX or .X (by assimp), glTF, GLB or VRM into one skeleton, one mesh, one skin. Throws InputError on
/// anything that cannot become a skinned character: missing, empty, truncated or hostile files, no joints, no skin,
/// indices or weights out of range, non-finite numbers, buffers or geometry outside of the file's folder; and when it
/// cannot be read apart from the program (rig/import/detail/box.h says what a reader may do). Names are plain text
/// (rig/text.h).
///
/// What the file says of its unit counts, whatever height that makes; a height that is none of a person's gets a note,
/// one below 5 cm is refused. A file that says nothing is read in the unit that makes a person's height.
Import import_character(const std::filesystem::path& file, const ImportOptions& options = {});

} // namespace tutu::rig
