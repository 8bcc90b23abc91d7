// Where a scene is on the maps of stability: its own step, stiffness, cells, proxies and speeds.
#pragma once

#include "src/run/scene.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::app {

struct GarmentSetting {
  std::string name;
  double step_limit = 0.0;     ///< s, the largest step of mass_spring (step_bound.h)
  double stiffest_cell = 0.0;  ///< m: square cells of this side and fabric vibrate as fast as the garment does
  double gap = 0.0;            ///< m that particles keep from colliders
  double largest_cell = 0.0;   ///< m, the longest edge along warp or weft at rest
  double mass_ratio = 1.0;     ///< of the heaviest particle that moves to the lightest
  bool only_particles = false; ///< meet colliders: edges and triangles are not asked
};

struct ProxySetting {
  std::string name;
  double radius = 0.0; ///< m
  double speed = 0.0;  ///< m/s, of its fastest point in the motion, cuts left out
};

struct SceneSetting {
  double step = 0.0; ///< s, a substep
  std::vector<GarmentSetting> garments;
  std::vector<ProxySetting> proxies; ///< that the garments can reach
};

/// Reads the motion (at most k_most_moments of its frames, evenly), and simulates nothing: some ten milliseconds.
SceneSetting scene_setting(const Scene& scene);
inline constexpr int k_most_moments = 2000;

/// m, the least of the garments'.
double least_gap(const SceneSetting& setting);

/// Of the garments, the one with the smallest step limit, and the one with the largest cell; of the proxies, the one
/// that is fastest for its radius with the least gap, and the thinnest. Null where there are none.
const GarmentSetting* stiffest(const SceneSetting& setting);
const GarmentSetting* coarsest(const SceneSetting& setting);
const ProxySetting* fastest(const SceneSetting& setting);
const ProxySetting* thinnest(const SceneSetting& setting);

/// How deep the deepest particle is inside a proxy when the motion begins.
struct StartOverlap {
  double depth = 0.0, radius = 0.0; ///< m
  std::string garment, proxy;       ///< empty: nothing overlaps
};
StartOverlap start_overlap(const Scene& scene, std::span<const std::vector<Vec3>> garment_positions);

} // namespace tutu::app
