// The skin in the colours of its distance from the proxies: cheap enough for every frame.
#pragma once

#include "proxies/capsule_union.h"
#include "src/render/frame_view.h"
#include "src/scene/scene.h"

#include <functional>
#include <optional>
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

/// The frame of the motion in which the skin sticks out of the proxies the most: by the 95th percentile over vertices
/// of how far each does. None without proxies, or when `progress(done, total)` returned false.
std::optional<int> worst_frame(const Scene& scene, const std::function<bool(int, int)>& progress);

} // namespace tutu::app
