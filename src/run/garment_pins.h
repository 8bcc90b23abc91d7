// Where the pins of garments are in a pose, and what the garments can reach from there.
#pragma once

#include "cloth/garment/reach.h"
#include "src/run/wearer.h"

#include <span>
#include <vector>

namespace tutu::app {

/// Places pins on joints and on skin. The wearer must outlive it. Allocates nothing once each garment was placed.
class GarmentPins {
public:
  explicit GarmentPins(const Wearer& wearer);

  /// Targets of garment `g`, world, m, in the order of Garment::pins.
  void place(std::size_t g, std::span<const Transform> world_from_joint, std::span<Vec3> targets);

private:
  const Wearer* wearer_;
  std::vector<Transform> rest_inverse_;          ///< joint_from_model at rest
  std::vector<SkinPinScratch> skin_pin_scratch_; ///< [garment]
};

/// What garments can reach in a pose: of a body and its proxies all that matters to them.
class WearerReach {
public:
  explicit WearerReach(const Wearer& wearer);

  /// Some garment hangs on nothing and may be anywhere.
  bool everything() const { return everything_; }

  /// The balls (capsules of no length) that all cloth is inside of in this pose, world, m; empty without garments.
  /// Good until the next call.
  std::span<const proxies::Capsule> balls(std::span<const Transform> world_from_joint);

private:
  GarmentPins pins_;
  std::vector<cloth::GarmentReach> garments_;
  GarmentPositions targets_;
  std::vector<proxies::Capsule> balls_;
  bool everything_ = false;
};

} // namespace tutu::app
