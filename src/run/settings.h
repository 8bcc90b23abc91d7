// How a scene is simulated: all that may be another without the scene being another.
#pragma once

#include "cloth/state/solver_options.h"
#include "proxies/query/collision_query.h"

namespace tutu::app {

inline constexpr int k_most_threads = 256;

struct RunSettings : cloth::SolverOptions {
  double frames_per_second = 60.0;
  int substeps = 10;             ///< a frame,
  bool adaptive_substeps = true; ///< and more where something moves too fast for them
  int threads = 1;               ///< that step garments side by side; never more than there are garments
  proxies::Backend backend = proxies::Backend::hybrid;
  /// How far free particles of a Session start from where they were put, at most, mm along each axis
  /// (cloth::make_uneven), as the seed has it. Nothing else in a run is random.
  double uneven_mm = 0.0;
  int seed = 1;

  double frame_seconds() const { return 1.0 / frames_per_second; }
  bool operator==(const RunSettings&) const = default;
};

} // namespace tutu::app
