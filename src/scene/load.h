// Scenes from their files.
#pragma once

#include "src/run/scene.h"
#include "src/run/worn_garment.h"
#include "src/scene/scene_file.h"

#include <string>
#include <vector>

namespace tutu::app {

/// A scene, and the files that it is of.
struct LoadedScene : Scene {
  SceneFiles files;
  std::vector<std::string> notes; ///< what the user should know: from the importer, the retargeting, units

  SceneDescription description() const { return {files, ground_height, wind, settings, {}, {}}; }
};

/// Reads everything a description names. Throws InputError; also for a setting that the file states, or that is
/// changed, and that a garment does not honour. One that only a change has made useless is noted.
LoadedScene load_scene(const SceneDescription& description);

/// A garment from its file, changed as the entry says, on the character. Throws InputError as read_garment and wear.
WornGarment put_on(const GarmentEntry& entry, const rig::Character& character);

/// The folder of the shipped assets: $TUTU_ASSETS, else share/tutu/assets beside an installed program, else assets/ of
/// the checkout the program was built in. Throws InputError when none of them is there.
std::filesystem::path assets_folder();

} // namespace tutu::app
