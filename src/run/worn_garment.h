// A garment as a character wears it: built, and each of its attachments on a joint.
#pragma once

#include "cloth/garment/garment.h"
#include "rig/character.h"
#include "src/run/skin_pins.h"

#include <vector>

namespace tutu::app {

struct WornGarment {
  cloth::Garment garment;
  std::vector<int> joints; ///< [attachment]; of one on the skin the joint that carries most of it
  SkinPins skin_pins;
};

/// Throws InputError as build_garment, and where an attachment names a joint that the character has not.
WornGarment wear(const cloth::GarmentDescription& description, const rig::Character& character);

} // namespace tutu::app
