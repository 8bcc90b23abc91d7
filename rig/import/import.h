// A character from a file, with the animations it brings.
#pragma once

#include "rig/character.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tutu::rig {

/// What the importer found and what it did about it, for `tutu inspect` and for warnings.
struct ImportReport {
  std::string format;         ///< "Collada", "glTF 2.0 binary", ...
  double metres_per_unit = 1; ///< applied to every length of the file
  std::string up_axis;        ///< "Y" or "Z" as found; the result is +Y up
  double height = 0;          ///< of the skinned rest pose, m
  int file_meshes = 0, file_skeletons = 0;
  int file_vertices = 0; ///< before welding
  int joints_without_weight = 0;
  int largest_influences = 0;     ///< of any vertex in the file
  int cut_vertices = 0;           ///< vertices that lost influences beyond the limit
  double largest_cut = 0;         ///< largest weight share a vertex lost
  std::vector<std::string> notes; ///< one sentence each: joints renamed, meshes left out, scale removed, ...
};

struct ImportOptions {
  int max_influences = 4; ///< 4 or 8
};

struct Import {
  Character character;
  std::vector<RawClip> clips; ///< animations of the file, on the joints of `character`, in m
  ImportReport report;
};

/// Reads Collada, glTF/GLB, FBX or .X (by assimp) into one skeleton, one mesh, one skin. Throws InputError on anything
/// that cannot become a skinned character: missing, empty, truncated or hostile files, no joints, no skin, indices or
/// weights out of range, non-finite numbers, buffers or geometry outside of the file's folder; and when it cannot be
/// read apart from the program (rig/import/detail/box.h says what a reader may do). Names are plain text (rig/text.h).
Import import_character(const std::filesystem::path& file, const ImportOptions& options = {});

} // namespace tutu::rig
