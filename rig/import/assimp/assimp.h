// Private to the importer: the formats that assimp 5.2.5 reads for us.
//
// assimp gives nodes, meshes and skins. Of motion it keeps keys, but not the law between them: what can be read from
// the file itself is (rig/import/collada, rig/import/fbx).
#pragma once

#include "rig/import/detail/file_scene.h"

#include <filesystem>

namespace tutu::rig::import_detail {

/// Throw InputError on files that cannot be read, on indices or weights out of range, on numbers that are none, and on
/// geometry or skins in another document. No file but the one named is opened.
FileScene read_collada(const std::filesystem::path& file);
FileScene read_fbx(const std::filesystem::path& file);
FileScene read_directx(const std::filesystem::path& file);
/// These have no joints and no motion.
FileScene read_obj(const std::filesystem::path& file);
FileScene read_ply(const std::filesystem::path& file);
FileScene read_stl(const std::filesystem::path& file);

} // namespace tutu::rig::import_detail
