#include "src/study/stability/maps.h"

#include "src/study/stability/step_bound.h"
#include "src/study/stability/trials.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace tutu::app {
namespace {

constexpr double k_least_gap = 1e-4; // m: cloth of no thickness is mapped as if of this much
/// s: between these the largest step is searched. Beyond the upper one it is a frame's, and no step.
constexpr double k_least_step = 1e-5, k_most_step = 1.0 / 30.0;

/// `own` times powers of `ratio`, from -below to above.
MapAxis powers(std::string name, std::string unit, double scale, double own, double ratio, int below, int above) {
  MapAxis axis{std::move(name), std::move(unit), scale, {}, own};
  for (int k = -below; k <= above; ++k) axis.values.push_back(own * std::pow(ratio, k));
  return axis;
}

/// As many below as above.
MapAxis around(std::string name, std::string unit, double scale, double own, double ratio, int each_way) {
  return powers(std::move(name), std::move(unit), scale, own, ratio, each_way, each_way);
}

/// The same of whole numbers >= 1.
MapAxis whole_around(std::string name, int own, double ratio, int each_way) {
  MapAxis axis{std::move(name), "", 1.0, {}, 1.0 * own};
  for (int k = -each_way; k <= each_way; ++k) {
    const double value = std::max(1.0, std::round(own * std::pow(ratio, k)));
    if (axis.values.empty() || value > axis.values.back()) axis.values.push_back(value);
  }
  return axis;
}

/// What all maps of a scene are made of.
struct Maker {
  const Scene& scene;
  const cloth::Garment& garment; ///< the stiffest,
  const GarmentSetting& own;     ///< and its setting
  double step;                   ///< s
  bool quick;

  double ratio() const { return quick ? 2.0 : std::sqrt(2.0); }
  int each_way() const { return quick ? 2 : 4; }

  Patch patch() const {
    Patch patch;
    patch.fabric = garment.fabric;
    patch.cell = own.stiffest_cell;
    patch.step = step;
    patch.solver.solver = scene.settings.solver;
    return patch;
  }
  MapAxis stiffness() const {
    return around("stretch stiffness", "N/m", 1.0, garment.fabric.stretch, quick ? 4.0 : 2.0, each_way());
  }
  MapAxis cells() const { return around("cell size", "mm", 1e3, own.stiffest_cell, ratio(), each_way()); }
  /// Farther down than up: what is stiff needs small ones.
  MapAxis steps() const { return powers("substep", "ms", 1e3, step, 2.0, quick ? 4 : 6, quick ? 2 : 4); }

  /// As the scene runs: 60 frames a second on the stage, in substeps as long as the scene's.
  RunSettings setup() const {
    RunSettings setup;
    setup.solver = scene.settings.solver;
    setup.substeps = std::max(1, static_cast<int>(std::lround(1.0 / (k_stability_frames_per_second * step))));
    setup.adaptive_substeps = scene.settings.adaptive_substeps;
    if (own.only_particles) setup.features = cloth::ContactFeatures::particles;
    return setup;
  }
  /// Particles only, not swept, never more substeps.
  RunSettings bare() const {
    RunSettings bare = setup();
    bare.features = cloth::ContactFeatures::particles;
    bare.swept = false;
    bare.adaptive_substeps = false;
    return bare;
  }
};

/// Closed form: the largest step of mass_spring for a patch made of each of `values`.
void add_bound(StabilityMap& map, const std::function<Patch(double value)>& patch) {
  for (const double value : map.x.values) map.bound.push_back(largest_stable_step(garment_of(patch(value))));
  map.bound_name = "by largest eigenvalue";
}

void add_outcome(MapCell& cell, Outcome outcome) { ++cell.outcomes[index_of(outcome)]; }

void add_step_maps(const Maker& maker, cloth::SolverKind kind, std::vector<StabilityMap>& maps) {
  const std::string solver(cloth::name_of(kind));
  Patch base = maker.patch();
  base.solver.solver = kind;
  const bool own = kind == maker.scene.settings.solver;
  const auto with = [base](double stretch, double cell, double step) {
    Patch patch = base;
    patch.fabric.stretch = stretch;
    patch.cell = cell;
    patch.step = step;
    return patch;
  };
  const double own_stretch = base.fabric.stretch, own_cell = base.cell;

  StabilityMap stiffness{
      "step-stiffness-" + solver, solver + ": step against stiffness",
      fmt::format("a patch of {}'s fabric hangs, in cells of {:.3g} mm", maker.own.name, 1e3 * own_cell),
      maker.stiffness(), maker.steps()};
  stiffness.own_method = own;
  stiffness.run = [=](double stretch, double step, std::uint64_t seed, MapCell& cell) {
    add_outcome(cell, hang(with(stretch, own_cell, step), seed));
  };
  StabilityMap cells{"step-cells-" + solver, solver + ": step against cell size",
                     fmt::format("a patch of {}'s fabric hangs ({:g} N/m)", maker.own.name, own_stretch), maker.cells(),
                     maker.steps()};
  cells.own_method = own;
  cells.run = [=](double size, double step, std::uint64_t seed, MapCell& cell) {
    add_outcome(cell, hang(with(own_stretch, size, step), seed));
  };
  if (kind == cloth::SolverKind::mass_spring) {
    add_bound(stiffness, [=](double stretch) { return with(stretch, own_cell, 1.0); });
    add_bound(cells, [=](double size) { return with(own_stretch, size, 1.0); });
  }
  StabilityMap largest{
      "largest-step-" + solver, solver + ": largest stable step, ms",
      fmt::format("a patch of {}'s fabric hangs; the step at which it stops to hold, by bisection", maker.own.name),
      maker.stiffness(), maker.cells()};
  largest.own_method = own;
  largest.of_steps = true;
  largest.run = [=, precision = maker.quick ? 1.2 : 1.05](double stretch, double size, std::uint64_t seed,
                                                          MapCell& cell) {
    const LargestStep found = find_largest_step([&](double step) { return hang(with(stretch, size, step), seed); },
                                                k_least_step, k_most_step, precision);
    cell.largest_step = std::min(cell.largest_step.value_or(found.step), found.step);
    add_outcome(cell, found.beyond);
  };
  maps.push_back(std::move(stiffness));
  maps.push_back(std::move(cells));
  maps.push_back(std::move(largest));
}

/// One map with the scene's safeguards, and its twin without.
void add_with_twin(const Maker& maker, StabilityMap map,
                   const std::function<void(const RunSettings&, double, double, std::uint64_t, MapCell&)>& run,
                   std::vector<StabilityMap>& maps) {
  StabilityMap twin = map;
  map.own_method = true;
  map.title += maker.own.only_particles ? " (particles only)" : " (as the scene runs)";
  map.run = [run, setup = maker.setup()](double x, double y, std::uint64_t seed, MapCell& cell) {
    run(setup, x, y, seed, cell);
  };
  twin.name += "-bare";
  twin.title += " (no safeguards)";
  twin.what += "; only particles meet it, nothing is swept, no substeps are added";
  twin.run = [run, setup = maker.bare()](double x, double y, std::uint64_t seed, MapCell& cell) {
    run(setup, x, y, seed, cell);
  };
  maps.push_back(std::move(map));
  maps.push_back(std::move(twin));
}

void add_leg_maps(const Maker& maker, const SceneSetting& setting, const ProxySetting& proxy,
                  std::vector<StabilityMap>& maps) {
  const double thickness = 2.0 * std::max(least_gap(setting), k_least_gap);
  constexpr double k_slowest = 0.25; // m/s; slower ones take long and tell nothing
  const bool moves = proxy.speed >= k_slowest;
  const auto speeds = [&] {
    MapAxis axis = around("collider speed", "m/s", 1.0, moves ? proxy.speed : 1.0, 2.0, maker.each_way());
    if (!moves) axis.own = std::nullopt;
    std::erase_if(axis.values, [](double speed) { return speed < k_slowest; });
    return axis;
  };
  const std::string what =
      fmt::format("a capsule as thin as {} ({:.3g} mm) goes through a hanging sheet", proxy.name, 1e3 * proxy.radius);
  const auto run = [radius = proxy.radius](const RunSettings& setup, double speed, double thick, std::uint64_t seed,
                                           MapCell& cell) {
    const StabilityScene scene = fast_leg(FastLeg{speed, radius, thick}, seed);
    add_outcome(cell, outcome_of(scene, run_stability(scene, setup)));
  };
  const std::string no_place = fmt::format("has no proxy near the garments that is faster than {} m/s", k_slowest);
  add_with_twin(maker,
                {"speed-thickness", "Speed against thickness", what, speeds(),
                 around("thickness, with twice the clearance", "mm", 1e3, thickness, 2.0, maker.each_way()), no_place},
                run, maps);
  add_with_twin(
      maker,
      {"speed-substeps", "Speed against substeps", what, speeds(),
       whole_around("substeps a frame (of 1/60 s)", maker.setup().substeps, 2.0, maker.each_way()), no_place},
      [=](RunSettings setup, double speed, double substeps, std::uint64_t seed, MapCell& cell) {
        setup.substeps = static_cast<int>(substeps);
        run(setup, speed, thickness, seed, cell);
      },
      maps);
}

void add_contact_maps(const Maker& maker, const GarmentSetting& coarsest, const ProxySetting& proxy,
                      std::vector<StabilityMap>& maps) {
  StabilityMap map{"cells-radius", "Cell size against proxy radius",
                   "a capsule pushes into a hanging sheet, in the middle of a cell, across the threads and along them; "
                   "stretch and rest are not judged",
                   around("cell size", "mm", 1e3, coarsest.largest_cell, maker.ratio(), maker.each_way()),
                   around("proxy radius", "mm", 1e3, proxy.radius, maker.ratio(), maker.each_way())};
  add_with_twin(
      maker, std::move(map),
      [](const RunSettings& setup, double size, double radius, std::uint64_t seed, MapCell& cell) {
        StabilityScene scene = coarse_cells(CoarseCells{size, radius, seed % 2 == 0}, seed);
        // Contacts are what it is about: a sheet of a hand's breadth is stretched by any limb, one of metres swings on.
        scene.limits.longer_p99 = scene.limits.speed = std::numeric_limits<double>::infinity();
        add_outcome(cell, outcome_of(scene, run_stability(scene, setup)));
      },
      maps);
}

void add_overlap_map(const Maker& maker, const ProxySetting& proxy, const StartOverlap& overlap,
                     std::vector<StabilityMap>& maps) {
  StabilityMap map{"overlap",
                   "Start-pose overlap against proxy radius",
                   "an arm stands in the wall of a tube at frame 0; at 100 % its axis is in the wall",
                   {"overlap, of the radius", "%", 100.0, {}, std::nullopt},
                   around("proxy radius", "mm", 1e3, overlap.depth > 0.0 ? overlap.radius : proxy.radius, maker.ratio(),
                          maker.quick ? 1 : 3)};
  // Beyond 100 % it is on the other side, and comes out there: another start, not a deeper one.
  for (const double share : {0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 1.0})
    if (!maker.quick || share == 0.2 || share == 0.4 || share == 0.6 || share == 0.8 || share == 0.95)
      map.x.values.push_back(share);
  if (overlap.depth > 0.0) map.x.own = overlap.depth / overlap.radius;
  map.no_place = "starts with no particle inside a proxy";
  map.own_method = true;
  map.run = [setup = maker.setup()](double share, double radius, std::uint64_t seed, MapCell& cell) {
    const StabilityScene scene = start_inside(StartInside{radius, share * radius, seed % 2 == 1}, seed);
    add_outcome(cell, outcome_of(scene, run_stability(scene, setup)));
  };
  maps.push_back(std::move(map));
}

void add_weight_map(const Maker& maker, std::vector<StabilityMap>& maps) {
  StabilityMap map{"mass-ratio",
                   "Mass ratio against step",
                   fmt::format("a patch of {}'s fabric hangs, its last row so much heavier", maker.own.name),
                   {"mass ratio", "", 1.0, {}, std::nullopt},
                   maker.steps()};
  for (double ratio = 1.0; ratio <= 4096.0; ratio *= maker.quick ? 8.0 : 4.0) map.x.values.push_back(ratio);
  map.x.own = maker.own.mass_ratio;
  map.own_method = true;
  map.run = [base = maker.patch()](double ratio, double step, std::uint64_t seed, MapCell& cell) {
    Patch patch = base;
    patch.mass_ratio = ratio;
    patch.step = step;
    add_outcome(cell, hang(patch, seed));
  };
  maps.push_back(std::move(map));
}

} // namespace

std::vector<StabilityMap> plan_maps(const Scene& scene, const SceneSetting& setting, const StartOverlap& overlap,
                                    const MapOptions& options) {
  const GarmentSetting* own = stiffest(setting);
  const cloth::Garment& garment = scene.garments[static_cast<std::size_t>(own - setting.garments.data())];
  const Maker maker{scene, garment, *own, setting.step, options.quick};
  std::vector<StabilityMap> maps;
  for (const cloth::SolverKind kind : {cloth::SolverKind::mass_spring, cloth::SolverKind::xpbd})
    add_step_maps(maker, kind, maps);
  if (const ProxySetting* proxy = fastest(setting)) add_leg_maps(maker, setting, *proxy, maps);
  if (const ProxySetting* proxy = thinnest(setting)) {
    add_contact_maps(maker, *coarsest(setting), *proxy, maps);
    add_overlap_map(maker, *proxy, overlap, maps);
  }
  add_weight_map(maker, maps);
  return maps;
}

} // namespace tutu::app
