// The one place that binds rig, proxies and cloth: everything of a scene that does not change while it plays.
#pragma once

#include "cloth/garment.h"
#include "proxies/collider.h"
#include "rig/character.h"
#include "src/scene/scene_file.h"
#include "src/scene/skin_pins.h"

#include <string>
#include <vector>

namespace tutu::app {

struct Scene {
  SceneDescription description;
  rig::Character character;
  rig::Clip clip;
  std::vector<proxies::Proxy> proxies;
  std::vector<cloth::Garment> garments;
  std::vector<std::vector<int>> attachment_joints; ///< [garment][attachment]: joint; of one on the skin, the main one
  std::vector<SkinPins> skin_pins;                 ///< [garment]: of attachments on the skin
  std::vector<std::string> notes; ///< what the user should know: from the importer, the retargeting, units

  std::string name() const { return description.file.stem().string(); }
};

/// Reads everything a description names. Throws InputError.
Scene load_scene(const SceneDescription& description);

/// The folder of the shipped assets: $TUTU_ASSETS, else share/tutu/assets beside an installed program, else assets/ of
/// the checkout the program was built in. Throws InputError when none of them is there.
std::filesystem::path assets_folder();

} // namespace tutu::app
