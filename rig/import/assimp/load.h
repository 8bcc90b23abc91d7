// Private to the reader by assimp: from bytes to assimp's scene, and from that to ours.
#pragma once

#include "rig/import/detail/file_scene.h"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct aiScene;

namespace tutu::rig::import_detail {

/// The bytes of `file` read by one of assimp's readers, triangulated, every vertex index in range; nothing is opened.
/// Throws InputError when they cannot be read, saying that `expected` was.
std::shared_ptr<const aiScene> load(const std::string& file, std::string_view bytes, const char* reader,
                                    const char* expected);

/// What a format knows of its nodes beyond assimp's names.
struct NodeNames {
  /// By assimp's name: the one for people. A node that is not in it keeps assimp's.
  std::map<std::string, std::string> shown;
  /// By assimp's name: what a skin may call the node, which others may be called too; else assimp's name.
  std::map<std::string, std::string> in_skins;
};

/// Nodes, meshes, skins and the materials' colours; of textures those outside of the file's folder are noted. Format,
/// unit and axes are the caller's to fill.
/// `node_of` (may be null) receives the node of each of assimp's names, the first of several.
FileScene scene_of(const aiScene& from, const std::string& file, const NodeNames& names = {},
                   std::map<std::string, int>* node_of = nullptr);

/// assimp's keys as linear ones, at `default_ticks` a second when the file says none; channels by name.
std::vector<FileAnimation> animations_of(const aiScene& from, const FileScene& scene, double default_ticks);

} // namespace tutu::rig::import_detail
