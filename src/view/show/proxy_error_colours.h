// The skin in the colours of its distance from the proxies: cheap enough for every frame.
#pragma once

#include "proxies/distance/capsule_union.h"
#include "src/view/render/frame_view.h"

#include <span>
#include <vector>

namespace tutu::app {

/// Colours vertices by their signed distance from the union of the colliders.
class ProxyErrorColours {
public:
  /// One colour a position; good until the next call. Positions and colliders: world, m.
  std::span<const Colour> update(std::span<const Vec3f> positions, std::span<const proxies::Capsule> colliders,
                                 const ErrorScale& scale);

private:
  proxies::CapsuleUnion union_;
  std::vector<Colour> colours_;
};

} // namespace tutu::app
