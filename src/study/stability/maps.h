// The maps of where methods fail, around the place of one scene.
#pragma once

#include "src/run/scene.h"
#include "src/study/stability/outcome.h"
#include "src/study/stability/scene_setting.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

struct MapAxis {
  std::string name, unit;
  double scale = 1.0;         ///< from SI to `unit`
  std::vector<double> values; ///< SI, rising, > 0
  std::optional<double> own;  ///< the scene's, SI

  /// Where a value is, in units of cells (0: the first one's middle), between logarithms; none beyond the outer cells.
  std::optional<double> place(double value) const;
};

struct MapCell {
  int starts = 0;                         ///< uneven, that were run
  std::array<int, k_outcomes> outcomes{}; ///< how many ended so; of a map of steps, how the next larger step ended
  std::optional<double> largest_step;     ///< s, of a map of steps: the smallest of the starts'

  int failed() const { return starts - outcomes[index_of(Outcome::held)]; }
  /// How most of those that did not hold ended; held where none failed.
  Outcome worst() const;
};

/// Cells of x.values by y.values. A map of outcomes tells how runs end at each; one of steps searches the largest
/// stable step there.
struct StabilityMap {
  std::string name; ///< of its files
  std::string title;
  std::string what; ///< one sentence: what was run
  MapAxis x, y;
  /// What to say of a scene that has no value on one of the axes.
  std::string no_place = "has no place on this map";
  bool of_steps = false;
  bool own_method = false;         ///< solver and safeguards are those of the scene
  std::vector<MapCell> cells = {}; ///< [y * x.values.size() + x]
  /// A closed form: y at which the first failure is expected, at each of x.values; empty: there is none.
  std::vector<double> bound = {};
  std::string bound_name = {};
  /// One uneven start at (x, y), into a cell. May be called from several threads.
  std::function<void(double x, double y, std::uint64_t seed, MapCell& cell)> run = {};

  MapCell& cell(std::size_t ix, std::size_t iy) { return cells[iy * x.values.size() + ix]; }
  const MapCell& cell(std::size_t ix, std::size_t iy) const { return cells[iy * x.values.size() + ix]; }
};

struct MapOptions {
  bool quick = false;
  int starts = 4;
  int threads = 1;
};

/// All maps of a scene, not yet run. Those of colliders only with proxies in reach. `overlap`: of the scene's start.
/// The scene must have a garment.
std::vector<StabilityMap> plan_maps(const Scene& scene, const SceneSetting& setting, const StartOverlap& overlap,
                                    const MapOptions& options);

/// Fills the cells: each from the starts 1 .. options.starts, whatever the number of threads. `progress(done, total)`
/// counts starts, one call at a time; when it returns false, the rest is left out and the result is false.
bool run_maps(std::vector<StabilityMap>& maps, const MapOptions& options,
              const std::function<bool(int done, int total)>& progress);

} // namespace tutu::app
