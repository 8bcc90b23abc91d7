// Where a garment can be at all, in a motion: for proxies that it can never meet.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/collider.h"
#include "rig/character.h"

#include <optional>
#include <span>
#include <vector>

namespace tutu::app {

/// For each proxy, how near any of the garments' cloth can come to its surface in any of the poses (model_from_joint),
/// by the balls of cloth/reach.h, m: above 0 it is never met. Nothing (no number) where some cloth hangs on no pin: it
/// may be anywhere. Pins are taken to ride rigidly on their attachment's joint, and those on the skin on the skin's
/// main joint there.
std::vector<std::optional<double>> garment_clearance(const rig::Character& character,
                                                     std::span<const cloth::Garment> garments,
                                                     std::span<const std::vector<int>> attachment_joints,
                                                     const std::vector<std::vector<Transform>>& poses,
                                                     std::span<const proxies::Proxy> proxies);

} // namespace tutu::app
