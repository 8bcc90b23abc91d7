// One run of one cell of a map: small, seeded, judged.
#pragma once

#include "cloth/solver.h"
#include "src/study/bench/stability_run.h"
#include "src/study/stability/outcome.h"

#include <cstdint>
#include <functional>

namespace tutu::app {

/// A square of fabric, ten particles a side, that hangs from its first row, shaken a little.
struct Patch {
  cloth::Fabric fabric;
  double cell = 0.02;      ///< m, a side
  double step = 1e-3;      ///< s, a substep
  double mass_ratio = 1.0; ///< particles of the last row over what they are without a weight
  cloth::SolverOptions solver;
};

cloth::Garment garment_of(const Patch& patch);

/// Lets it hang for two seconds (or as many as k_most_patch_steps steps are) on the bare solver: nothing is taken back,
/// no substeps are added. A sheet that is longer than its load explains by more than k_patch_longer has failed.
Outcome hang(const Patch& patch, std::uint64_t seed);
inline constexpr int k_least_patch_steps = 200, k_most_patch_steps = 4000;
inline constexpr double k_patch_longer = 0.10; ///< p99 of threads, as StabilityLimits has it

/// Where a method stops to hold when its step grows.
struct LargestStep {
  double step = 0.0;              ///< s, the largest that held; 0 when the smallest did not
  Outcome beyond = Outcome::held; ///< how the next one failed; held: none up to the largest asked for
};

/// By bisection between `low` and `high` s until both sides are within the factor `precision` (> 1). What holds at a
/// step is taken to hold below it.
LargestStep find_largest_step(const std::function<Outcome(double step)>& run, double low, double high,
                              double precision);

/// What a scene of stability came to. The first of what is wrong, in the order of Outcome, tunnelling before stretch:
/// a sheet around a limb that went through it is long because of that.
Outcome outcome_of(const StabilityScene& scene, const StabilityRun& run);

} // namespace tutu::app
