#include "src/run/wearer.h"

#include "rig/error.h"
#include "src/run/met_colliders.h"
#include "src/run/worn_garment.h"

#include <algorithm>
#include <stdexcept>

namespace tutu::app {

void Wearer::put_on(const cloth::GarmentDescription& garment) {
  check_met_colliders(garment.met, garment.file, proxies, character.skeleton);
  WornGarment worn = wear(garment, character);
  garments.push_back(std::move(worn.garment));
  attachment_joints.push_back(std::move(worn.joints));
  skin_pins.push_back(std::move(worn.skin_pins));
}

bool Wearer::has_air() const {
  return std::any_of(garments.begin(), garments.end(),
                     [](const cloth::Garment& garment) { return garment.fabric.air.has_value(); });
}

proxies::BodyMesh body_of(const rig::Character& character) {
  try {
    return {character.mesh.positions, character.mesh.triangles};
  } catch (const std::invalid_argument& unusable) {
    throw InputError(character.file + ": " + unusable.what(), "", "", "");
  }
}

} // namespace tutu::app
