#include "src/run/worn_garment.h"

#include "rig/error.h"

namespace tutu::app {

WornGarment wear(const cloth::GarmentDescription& description, const rig::Character& character) {
  WornGarment worn;
  worn.garment = cloth::build_garment(description);
  worn.skin_pins = bind_to_skin(worn.garment, character);
  for (std::size_t a = 0; a < worn.garment.attachments.size(); ++a) {
    if (worn.garment.attachments[a].skin) {
      worn.joints.push_back(main_joint(worn.skin_pins, worn.garment, static_cast<int>(a)));
      continue;
    }
    const std::string& name = worn.garment.attachments[a].joint;
    const auto joint = character.skeleton.find(name);
    if (!joint)
      throw InputError(description.file, "/attachments/" + std::to_string(a) + "/joint", '"' + name + '"',
                       "a joint of " + character.file);
    worn.joints.push_back(*joint);
  }
  return worn;
}

} // namespace tutu::app
