// Garments that settle on the still body: where a run starts from.
#pragma once

#include "src/run/runtime.h"
#include "src/run/scene.h"

#include <functional>
#include <optional>

namespace tutu::app {

/// Garments settled on the still body, in two phases: the body goes from its rest pose to a first pose (the garments
/// are built around the rest pose), then stands until no particle is faster than k_settled_speed or `longest` has
/// passed. Of the wind the steady part alone blows: in gusts nothing settles.
struct DrapeResult {
  GarmentPositions positions; ///< world, m, one vector a garment
  double seconds = 0.0;       ///< simulated
  double fastest = 0.0;       ///< m/s at the end
  std::optional<RunFailure> failure;
};
/// `first`: the pose, parent_from_joint; of a scene that of its clip. `progress(done, total)` is called each frame;
/// returning false stops (the positions so far are returned). So does `stop` within a frame (Runtime::stop_when),
/// without a call for it.
DrapeResult drape(const Wearer& wearer, std::span<const Transform> first, double longest,
                  const std::function<bool(int, int)>& progress, const std::atomic<bool>* stop = nullptr);
DrapeResult drape(const Scene& scene, double longest, const std::function<bool(int, int)>& progress,
                  const std::atomic<bool>* stop = nullptr);

/// Of everything a drape depends on: garments, steady wind, first pose, proxies, ground, solver settings.
std::uint64_t drape_fingerprint(const Scene& scene);

} // namespace tutu::app
