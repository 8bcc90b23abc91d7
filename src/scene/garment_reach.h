// Where a garment can be at all, in a motion: for proxies that it can never meet.
#pragma once

#include "cloth/garment.h"
#include "proxies/collider.h"
#include "rig/character.h"

#include <optional>
#include <span>
#include <vector>

namespace tutu::app {

/// Cloth is taken to stretch by no more than this when its reach is asked for.
inline constexpr double k_reach_stretch = 1.2;

/// For each proxy, how near any of the garments' cloth can come to it in any of the poses (model_from_joint): the
/// least, over particles and poses, of the distance from the particle's pin to the proxy's surface less the length of
/// cloth between particle and pin (along the tethers) times k_reach_stretch, and less what particles keep from
/// colliders. Above 0 it is never met. Nothing (no number) where a garment has no pin: it may be anywhere. Pins
/// are taken to ride rigidly on their attachment's joint, and those on the skin on the skin's main joint there.
std::vector<std::optional<double>> garment_clearance(const rig::Character& character,
                                                     std::span<const cloth::Garment> garments,
                                                     std::span<const std::vector<int>> attachment_joints,
                                                     const std::vector<std::vector<Transform>>& poses,
                                                     std::span<const proxies::Proxy> proxies);

} // namespace tutu::app
