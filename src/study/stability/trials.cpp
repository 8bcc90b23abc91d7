#include "src/study/stability/trials.h"

#include "cloth/garment/uneven.h"
#include "cloth/metrics.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace tutu::app {
namespace {

constexpr int k_side = 10;             // particles
constexpr double k_shaken = 5e-4;      // of a cell: wakes every vibration, and is slow enough to count as at rest
constexpr double k_seconds = 2.0;      // of a patch: its slowest swing has come to rest by then
constexpr double k_patch_drag = 3.0;   // 1/s, on top of the fabric's
constexpr double k_rest_speed = 0.5;   // m/s, as StabilityLimits has it
constexpr double k_gravity = 9.81;     // m/s2
constexpr double k_frame = 1.0 / 60.0; // s

/// The most that any edge along the warp gives by the weight below it, over its length.
double static_strain(const cloth::Garment& garment) {
  double most = 0.0;
  for (const cloth::Spring& spring : garment.springs) {
    if (spring.kind != cloth::SpringKind::structural || spring.j != spring.i + garment.columns) continue;
    double below = 0.0; // kg
    for (int i = spring.j; i < garment.particle_count(); i += garment.columns) below += garment.masses[i];
    most = std::max(most, below * k_gravity / spring.stiffness / spring.rest_length);
  }
  return most;
}

std::vector<Vec3> shaken(const cloth::Garment& garment, double by, std::uint64_t seed) {
  std::vector<Vec3> positions = garment.rest_positions;
  std::mt19937_64 random(seed);
  cloth::make_uneven(garment, by, random, positions);
  return positions;
}

} // namespace

cloth::Garment garment_of(const Patch& patch) {
  const double size = (k_side - 1) * patch.cell;
  cloth::GarmentDescription description;
  description.name = "patch";
  description.shape = cloth::GridShape{k_side, k_side, {-0.5 * size, 1, 0}, {size, 0, 0}, {0, -size, 0}};
  description.fabric = patch.fabric;
  description.attachments = {{"stage", 0, 0, 0, -1}};
  cloth::Garment garment = cloth::build_garment(description);
  for (int i = garment.particle_count() - k_side; i < garment.particle_count(); ++i)
    garment.masses[i] *= patch.mass_ratio;
  return garment;
}

Outcome hang(const Patch& patch, std::uint64_t seed) {
  const cloth::Garment garment = garment_of(patch);
  const auto solver = cloth::make_solver(garment, patch.solver);
  solver->reset(shaken(garment, k_shaken * patch.cell, seed));
  const auto query = proxies::make_query(proxies::Backend::brute);
  std::vector<Vec3> pins;
  for (const cloth::Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  cloth::FrameInput input;
  input.pins_start = input.pins_end = pins;
  input.substeps = std::max(1, static_cast<int>(std::lround(k_frame / patch.step)));
  input.seconds = input.substeps * patch.step;
  input.extra_drag = k_patch_drag;
  const int steps =
      static_cast<int>(std::clamp(k_seconds / patch.step, 1.0 * k_least_patch_steps, 1.0 * k_most_patch_steps));
  for (int done = 0; done < steps; done += input.substeps)
    if (solver->step(input, *query)) return Outcome::diverged;

  const double longer = cloth::thread_strains(cloth::MeasuredParts(garment), solver->particles().positions).longer.p99;
  // Written so that what is no number has failed.
  if (!(longer <= k_patch_longer + static_strain(garment))) return Outcome::stretched;
  for (const Vec3& v : solver->particles().velocities)
    if (!(v.norm() <= k_rest_speed)) return Outcome::unsettled;
  return Outcome::held;
}

LargestStep find_largest_step(const std::function<Outcome(double step)>& run, double low, double high,
                              double precision) {
  LargestStep found;
  found.beyond = run(low);
  if (found.beyond != Outcome::held) return found;
  found.beyond = run(high);
  if (found.beyond == Outcome::held) return {high, Outcome::held};
  while (high > precision * low) {
    const double middle = std::sqrt(low * high);
    const Outcome outcome = run(middle);
    if (outcome == Outcome::held) {
      low = middle;
    } else {
      high = middle;
      found.beyond = outcome;
    }
  }
  found.step = low;
  return found;
}

Outcome outcome_of(const StabilityScene& scene, const StabilityRun& run) {
  const StabilityLimits& limits = scene.limits;
  if (!run.failure.empty()) return Outcome::diverged;
  if (run.crossings > 0 || run.pierced_at_end > 0) return Outcome::tunnelled;
  if (!(run.longer_p99 <= limits.longer_p99)) return Outcome::stretched;
  return run.depth <= limits.depth && run.speed <= limits.speed ? Outcome::held : Outcome::unsettled;
}

} // namespace tutu::app
