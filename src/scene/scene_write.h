// Scenes to disk.
#pragma once

#include "src/scene/scene_file.h"

namespace tutu::app {

/// Writes what read_scene reads back, every key with its value, paths as seen from the file's folder; d.file is not
/// looked at. Throws as write_file.
void write_scene(const SceneDescription& d, const std::filesystem::path& file, const std::string& comment = "");

} // namespace tutu::app
