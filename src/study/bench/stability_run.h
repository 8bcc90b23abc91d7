// Runs a stability scene as a session would run it: guarded, with adaptive substeps; and judges the end.
#pragma once

#include "cloth/solver.h"
#include "src/measure/crossings.h"
#include "src/measure/run_end.h"
#include "src/run/settings.h"
#include "src/study/bench/crossings.h"
#include "src/study/bench/stability_scenes.h"

#include <string>
#include <vector>

namespace tutu::app {

struct StabilityRun {
  int frames = 0;          ///< done
  std::string failure;     ///< why it stopped early; empty when it did not
  int crossings = 0;       ///< CrossingCounter
  int pierced = 0;         ///< triangles, summed over frames
  int pierced_at_end = 0;  ///< triangles
  CrossingTally limbs;     ///< places where cloth stands in limbs (GarmentSurface), in the frames looked at
  CrossingTally itself;    ///< and in itself
  double longer_p99 = 0.0; ///< of free threads (cloth/metrics.h), at the end
  double longer_max = 0.0; ///< of any of them in any frame
  double depth = 0.0;      ///< m, of the deepest particle, at the end
  double surface = 0.0;    ///< m, of the deepest sample of a triangle, at the end
  double deepest = 0.0;    ///< m, of any such sample in the frames looked at
  GarmentEnd left;         ///< at the end, in the colliders
  double speed = 0.0;      ///< m/s, of the fastest particle, at the end
  double turn_rate = 0.0;  ///< rad/s about the vertical axis through the origin, at the end, of the cloth as a whole
  int recoveries = 0;
  int most_substeps = 0;
  double ms = 0.0; ///< a frame, of the thread's time, in the middle
  cloth::Particles end;
};

/// After which frames surfaces are looked at: that takes several times as long as a frame.
enum class SurfaceLooks { never, every_frame };

StabilityRun run_stability(const StabilityScene& scene, const RunSettings& setup,
                           SurfaceLooks looks = SurfaceLooks::never);

/// What does not hold, in words; none: the run passed.
std::vector<std::string> broken_limits(const StabilityScene& scene, const StabilityRun& run);

} // namespace tutu::app
