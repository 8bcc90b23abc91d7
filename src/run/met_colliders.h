// Which colliders a garment meets.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/collider.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tutu::app {

/// One a collider: 1 where the garment does not meet it, by its "ignore" or "only" (MetColliders). Empty where it meets
/// all.
std::vector<std::uint8_t> ignored_by(const cloth::Garment& garment, std::span<const proxies::Proxy> colliders,
                                     const rig::Skeleton& skeleton);

/// Throws InputError for a name, in the garment's `file`, that is no joint and no proxy.
void check_met_colliders(const cloth::MetColliders& met, const std::string& file,
                         std::span<const proxies::Proxy> proxies, const rig::Skeleton& skeleton);

} // namespace tutu::app
