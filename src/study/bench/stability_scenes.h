// The standard scenes of stability: one builder each for tests, `tutu bench` and figures. Nothing is read from disk.
//
// World: m, kg, s; y up, gravity (0, -9.81, 0), 60 frames a second. Starts are uneven by a seed, so that a scene is
// as many runs as wanted and none of them is an accident of symmetry.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/shapes.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tutu::app {

inline constexpr int k_stability_frames_per_second = 60;
inline constexpr double k_stability_uneven = 0.001; ///< m, of the free particles' start (cloth::make_uneven)
inline constexpr int k_stability_runs = 10;         ///< uneven starts of a scene, with the seeds from 1 on

/// What must hold. Those at the end: after the scene's last frame.
struct StabilityLimits {
  bool crossings = true;    ///< none may be, from the first frame to the last
  double longer_p99 = 0.10; ///< at the end, of free threads (cloth/metrics.h); own weight gives 2 %
  double depth = 0.001;     ///< m at the end, of the deepest particle
  double speed = 0.5;       ///< m/s at the end, of the fastest particle
  /// rad/s at the end, about the vertical through the origin, of the cloth as a whole: least and most.
  std::optional<std::pair<double, double>> turn_rate;
};

struct StabilityScene {
  std::string name; ///< with its variant: "fast-leg 30 m/s"
  cloth::Garment garment;
  std::vector<Vec3> start; ///< at rest
  /// Colliders and pins at time t. Both have the same number of entries at all times.
  std::function<void(double t, std::vector<proxies::Capsule>& capsules, std::vector<Vec3>& pins)> pose;
  std::vector<Vec3> spin; ///< rad/s, of each collider; empty: none turns
  double friction = 0.3;
  double seconds = 2.0;
  /// The frame that a jump by `jump` belongs to, where the solver is told of one: cloth is moved along, at rest.
  std::optional<int> told_jump_frame;
  Vec3 jump = Vec3::Zero();
  StabilityLimits limits;
  /// How often a frame is looked for crossings, as far as its substeps can be shared out so: between two looks all is
  /// taken to move on straight lines, which cloth that whips around a thin limb does not within a frame.
  int looks = 1;
};

/// What the cloth is made of: threads, or irregular triangles as an imported garment is (mesh_sheet.h), about as many.
enum class Weave { threads, mesh };

/// A capsule goes through a sheet of 0.6 m that hangs from its upper row, along its normal, and stops where the sheet
/// still reaches around it.
struct FastLeg {
  double speed = 1.0;                           ///< m/s
  double radius = 0.06;                         ///< m
  double thickness = cloth::Fabric().thickness; ///< m, of the cloth
  Weave weave = Weave::threads;
};
StabilityScene fast_leg(const FastLeg& leg, std::uint64_t seed);
StabilityScene fast_leg(double speed, std::uint64_t seed, Weave weave = Weave::threads);

/// A capsule pushes at 1 m/s into a hanging sheet of five by five cells, at the middle of a cell, lying across the warp
/// (or, upright, along it).
struct CoarseCells {
  double cell = 0.06;   ///< m, a side
  double radius = 0.03; ///< m
  bool along_warp = false;
  Weave weave = Weave::threads;
};
StabilityScene coarse_cells(const CoarseCells& cells, std::uint64_t seed);
/// The same with a capsule of 3 cm, the cells `cells` times as large as its diameter.
StabilityScene coarse_cells(double cells, bool along_warp, std::uint64_t seed, Weave weave = Weave::threads);

/// An arm stands in the wall of a tube at frame 0 with its axis within the tube or outside it.
struct StartInside {
  double radius = 0.05; ///< m
  double depth = 0.03;  ///< m, how far its surface is through the wall
  bool axis_within = true;
  Weave weave = Weave::threads;
};
StabilityScene start_inside(const StartInside& arm, std::uint64_t seed);
StabilityScene start_inside(bool axis_within, std::uint64_t seed, Weave weave = Weave::threads);

/// A skirt over hips and two legs, all of which jump by 5 m in one frame: told to the solver or not.
StabilityScene teleport(bool told, std::uint64_t seed, Weave weave = Weave::threads);

/// Free particles anywhere in the cube around a hanging sheet.
StabilityScene randomised(std::uint64_t seed, Weave weave = Weave::threads);

/// A hanging tube pressed into one plane: upright (through its axis) or level (at its waist).
StabilityScene flattened(bool upright, std::uint64_t seed, Weave weave = Weave::threads);

/// A tube held at both ends; the lower one is turned three times round within 2 s, drawn up as far as the twist needs,
/// and turned back.
StabilityScene twist(std::uint64_t seed, Weave weave = Weave::threads);

/// A sheet falls into a funnel of sixteen capsules.
StabilityScene funnel(std::uint64_t seed, Weave weave = Weave::threads);

/// A sheet lies on a ball that turns about the vertical: with friction it must come to turn with it, without it must
/// not.
StabilityScene rotating_sphere(double friction, std::uint64_t seed, Weave weave = Weave::threads);
inline constexpr double k_sphere_turn_rate = 2.0; ///< rad/s

/// The variants of one scene, by the name of the command line; of irregular triangles with "-mesh" behind it. Builders
/// take the seed.
struct StabilityFamily {
  std::string name, what;
  std::vector<std::function<StabilityScene(std::uint64_t)>> variants;
};
const std::vector<StabilityFamily>& stability_families();

} // namespace tutu::app
