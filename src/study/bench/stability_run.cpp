#include "src/study/bench/stability_run.h"

#include "cloth/adaptive_substeps.h"
#include "cloth/recovery.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace tutu::app {
namespace {

using proxies::Capsule;

double turn_rate_of(const cloth::Particles& particles) {
  double moment = 0.0, inertia = 0.0; // of equal masses
  for (int i = 0; i < particles.count(); ++i) {
    const Vec3 &x = particles.positions[i], &v = particles.velocities[i];
    moment += x.z() * v.x() - x.x() * v.z();
    inertia += x.x() * x.x() + x.z() * x.z();
  }
  return inertia > 0.0 ? moment / inertia : 0.0;
}

/// The most equal parts, `wanted` at most, into which so many substeps can be shared out.
int parts_of(int substeps, int wanted) {
  int parts = std::clamp(wanted, 1, substeps);
  while (substeps % parts != 0) --parts;
  return parts;
}

void judge_end(const StabilityScene& scene, const ClothProbe& probe, const std::vector<Capsule>& capsules,
               StabilityRun& run) {
  run.longer_p99 = cloth::thread_strains(probe.parts(), run.end.positions).longer.p99;
  ClothDepths depths;
  probe.measure(capsules, std::nullopt, run.end.positions, depths);
  run.depth = depths.particles.deepest;
  run.surface = depths.surface;
  run.left = {scene.name, cloth::longest_thread(probe.parts(), run.end.positions), deepest_of(depths), {}};
  for (const Vec3& v : run.end.velocities) run.speed = std::max(run.speed, v.norm());
  run.turn_rate = turn_rate_of(run.end);
}

} // namespace

StabilityRun run_stability(const StabilityScene& scene, const RunSettings& setup, SurfaceLooks looks) {
  const int parts = parts_of(setup.substeps, scene.looks);
  const double part_seconds = 1.0 / (k_stability_frames_per_second * parts);
  const int steps = static_cast<int>(std::lround(scene.seconds * k_stability_frames_per_second)) * parts;
  const auto query = proxies::make_query(setup.backend);
  cloth::GuardedSolver solver(cloth::make_solver(scene.garment, setup), scene.garment);
  solver.reset(scene.start);
  CrossingCounter counter(scene.garment);
  std::optional<GarmentSurface> surface; // its tree is not built for nothing
  if (looks == SurfaceLooks::every_frame) surface.emplace(scene.garment);

  std::vector<Capsule> capsules, capsules_before;
  std::vector<Vec3> pins, pins_before, spin = scene.spin;
  for (Vec3& turn : spin) turn *= part_seconds;
  scene.pose(0.0, capsules, pins);
  counter.start(scene.start, capsules);
  const std::vector<double> friction(capsules.size() + 1, scene.friction);

  const ClothProbe probe(scene.garment);
  StabilityRun run;
  std::vector<double> ms;
  for (int step = 0; step < steps && run.failure.empty(); ++step) {
    const int frame = step / parts;
    capsules_before.swap(capsules);
    pins_before.swap(pins);
    scene.pose((step + 1) * part_seconds, capsules, pins);
    if (scene.told_jump_frame == frame && step % parts == 0) {
      std::vector<Vec3> moved = solver.particles().positions;
      for (Vec3& p : moved) p += scene.jump;
      solver.reset(moved);
      capsules_before = capsules;
      pins_before = pins;
      counter = CrossingCounter(scene.garment);
      counter.start(moved, capsules);
    }
    cloth::FrameInput input;
    input.colliders = {capsules_before, capsules, std::nullopt, spin};
    input.friction = friction;
    input.pins_start = pins_before;
    input.pins_end = pins;
    input.seconds = part_seconds;
    input.substeps = setup.substeps / parts;
    const auto begin = std::chrono::steady_clock::now();
    if (setup.adaptive_substeps)
      input.substeps =
          cloth::plan_substeps(input, cloth::extent_of(solver.particles()), scene.garment.fabric.contact_offset())
              .substeps;
    const auto end = solver.step(input, *query);
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    run.most_substeps = std::max(run.most_substeps, parts * solver.substeps());
    run.recoveries += solver.recovery() && !end;
    if (const cloth::Divergence* bad = cloth::divergence_of(end))
      run.failure = fmt::format("diverged in frame {}: {}", frame, cloth::what_was_found(*bad));
    else run.frames = (step + 1) / parts;
    counter.advance(solver.particles().positions, capsules);
    if (surface && (step + 1) % parts == 0) {
      surface->move(solver.particles().positions);
      run.limbs.add(frame, surface->with(capsules));
      run.itself.add(frame, surface->with_itself());
      ClothDepths depths;
      probe.measure(capsules, std::nullopt, solver.particles().positions, depths);
      run.deepest = std::max(run.deepest, depths.surface);
    }
    run.longer_max =
        std::max(run.longer_max, cloth::longest_thread(probe.parts(), solver.particles().positions).longer);
  }
  run.crossings = counter.crossings();
  run.pierced = counter.pierced();
  run.pierced_at_end = counter.pierced_now();
  run.ms = parts * cloth::percentile(ms, 0.5);
  run.end = solver.particles();
  judge_end(scene, probe, capsules, run);
  return run;
}

std::vector<std::string> broken_limits(const StabilityScene& scene, const StabilityRun& run) {
  std::vector<std::string> broken;
  const StabilityLimits& limits = scene.limits;
  if (!run.failure.empty()) broken.push_back(run.failure);
  if (limits.crossings && run.crossings > 0) broken.push_back(fmt::format("{} crossings", run.crossings));
  if (limits.crossings && run.pierced > 0)
    broken.push_back(fmt::format("{} triangles pierced over all frames", run.pierced));
  // Written so that what is no number is broken too.
  if (!(run.longer_p99 <= limits.longer_p99))
    broken.push_back(
        fmt::format("threads longer, p99, {:.3g} % > {:.3g} %", 100.0 * run.longer_p99, 100.0 * limits.longer_p99));
  if (!(run.depth <= limits.depth))
    broken.push_back(fmt::format("depth {:.3g} mm > {:.3g} mm", 1e3 * run.depth, 1e3 * limits.depth));
  if (!(run.speed <= limits.speed))
    broken.push_back(fmt::format("speed {:.3g} m/s > {:.3g} m/s", run.speed, limits.speed));
  if (limits.turn_rate && !(run.turn_rate >= limits.turn_rate->first && run.turn_rate <= limits.turn_rate->second))
    broken.push_back(fmt::format("turns at {:.3g} rad/s, expected {:.3g} to {:.3g}", run.turn_rate,
                                 limits.turn_rate->first, limits.turn_rate->second));
  return broken;
}

} // namespace tutu::app
