#include "src/scene/worn_garment.h"

#include "cloth/garment_file.h"
#include "rig/error.h"

namespace tutu::app {

WornGarment put_on(const GarmentEntry& entry, const rig::Character& character, const std::string& character_file) {
  WornGarment worn;
  worn.garment = cloth::build_garment(
      cloth::fitted(cloth::resampled(cloth::read_garment(entry.file), entry.resolution), entry.scale, entry.offset));
  worn.skin_pins = bind_to_skin(worn.garment, character);
  for (std::size_t a = 0; a < worn.garment.attachments.size(); ++a) {
    if (worn.garment.attachments[a].skin) {
      worn.joints.push_back(main_joint(worn.skin_pins, worn.garment, static_cast<int>(a)));
      continue;
    }
    const std::string& name = worn.garment.attachments[a].joint;
    const auto joint = character.skeleton.find(name);
    if (!joint)
      throw InputError(entry.file.string(), "/attachments/" + std::to_string(a) + "/joint", '"' + name + '"',
                       "a joint of " + character_file);
    worn.joints.push_back(*joint);
  }
  return worn;
}

} // namespace tutu::app
