#include "src/run/garment_pins.h"

namespace tutu::app {

GarmentPins::GarmentPins(const Wearer& wearer) : wearer_(&wearer), skin_pin_scratch_(wearer.garments.size()) {
  for (const Transform& joint : rig::rest_model(wearer.character.skeleton)) rest_inverse_.push_back(joint.inverse());
}

void GarmentPins::place(std::size_t g, std::span<const Transform> world, std::span<Vec3> targets) {
  const cloth::Garment& garment = wearer_->garments[g];
  for (std::size_t k = 0; k < garment.pins.size(); ++k) {
    if (garment.attachments[garment.pins[k].attachment].skin) continue;
    const int joint = wearer_->attachment_joints[g][garment.pins[k].attachment];
    targets[k] = world[joint] * (rest_inverse_[joint] * garment.rest_positions[garment.pins[k].particle]);
  }
  place_on_skin(wearer_->skin_pins[g], world, skin_pin_scratch_[g], targets);
}

WearerReach::WearerReach(const Wearer& wearer) : pins_(wearer) {
  for (const cloth::Garment& garment : wearer.garments) {
    garments_.emplace_back(garment);
    targets_.emplace_back(garment.pins.size());
    everything_ = everything_ || !garments_.back().bounded();
  }
}

std::span<const proxies::Capsule> WearerReach::balls(std::span<const Transform> world) {
  balls_.clear();
  for (std::size_t g = 0; g < garments_.size(); ++g) {
    pins_.place(g, world, targets_[g]);
    garments_[g].place(targets_[g], balls_);
  }
  return balls_;
}

} // namespace tutu::app
