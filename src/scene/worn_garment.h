// A garment as a character wears it: built, and each of its attachments on a joint.
#pragma once

#include "cloth/garment.h"
#include "rig/character.h"
#include "src/scene/scene_file.h"
#include "src/scene/skin_pins.h"

#include <string>
#include <vector>

namespace tutu::app {

struct WornGarment {
  cloth::Garment garment;
  std::vector<int> joints; ///< [attachment]; of one on the skin the joint that carries most of it
  SkinPins skin_pins;
};

/// `character_file` is what errors call the character. Throws InputError as read_garment and bind_to_skin, and where an
/// attachment names a joint that the character has not.
WornGarment put_on(const GarmentEntry& entry, const rig::Character& character, const std::string& character_file);

} // namespace tutu::app
