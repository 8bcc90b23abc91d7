#include "src/study/plan/plan_bench.h"

#include "src/base/workers.h"
#include "src/run/posed_body.h"
#include "src/run/session.h"
#include "src/scene/load.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <thread>

namespace tutu::app {
namespace {

constexpr int k_guard_starts = 3; // folds fall one way or the other: one start says little about a drape
constexpr double k_seldom = 15.0; // 1/s: how often a quick run is measured against the body
constexpr double k_far = 2.0;     // times too deep: not to be helped
constexpr double k_between = 1.1; // deeper between the frames of a quick run, and from other starts
constexpr int k_skinned_poses = 20;

PlanCost cost_of(const CellRun& run) {
  std::vector<double> ms = run.ms;
  return {cloth::percentile(ms, 0.5), cloth::percentile(ms, 0.99)};
}

std::string trouble_of(const CellRun& run) {
  if (!run.failure.empty()) return run.failure;
  return run.recoveries > 0 ? fmt::format("{} frames diverged and were taken again", run.recoveries) : "";
}

double median(std::vector<double> values) { return cloth::percentile(values, 0.5); }

struct Part {
  double share;
  std::string words;
};

std::vector<Part> parts_of(const PlanErrors& e, const PlanLimits& l) {
  std::vector<Part> parts;
  const auto add = [&](double value, std::optional<double> most, const char* words) {
    if (most)
      parts.push_back({value / *most, fmt::format("{:.2f} mm {} ({:.2f} allowed)", 1e3 * value, words, 1e3 * *most)});
  };
  add(e.body, l.body, "in the body");
  add(e.trajectory, l.trajectory, "off the reference's first second");
  add(e.drape, l.drape, "off its settled shape");
  parts.push_back({e.longer_p99 / l.longer_p99,
                   fmt::format("threads {:.1f} % longer ({:.1f} allowed)", 1e2 * e.longer_p99, 1e2 * l.longer_p99)});
  return parts;
}

} // namespace

double excess_of(const PlanErrors& errors, const PlanLimits& limits) {
  if (!errors.trouble.empty()) return std::numeric_limits<double>::infinity();
  double excess = 0.0;
  for (const Part& part : parts_of(errors, limits)) excess = std::max(excess, part.share);
  return excess;
}

std::string worst_of(const PlanErrors& errors, const PlanLimits& limits) {
  if (!errors.trouble.empty()) return errors.trouble;
  const std::vector<Part> parts = parts_of(errors, limits);
  return std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.share < b.share; })
      ->words;
}

PlanBench::PlanBench(const LoadedScene& scene, const PlanGoal& goal, const ReferencePlan& plan,
                     std::optional<Reference> reference, GarmentPositions start, std::function<bool()> go_on)
    : scene_(&scene), goal_(goal), guard_(plan.protocol), reference_(std::move(reference)), start_(std::move(start)),
      go_on_(std::move(go_on)) {
  guard_.held = 0; // jitter is not asked for
  if (reference_)
    reference_garments_ = with_setting(scene, reference_setting(scene, plan, reference_->substeps)).garments;
  PlanModel own;
  own.setting = own_setting(scene.settings);
  const std::vector<CellRun> runs = run_starts(scene, own);
  for (const CellRun& run : runs) {
    add_body(run, own_);
    own_runs_.push_back(run.trajectory);
  }
  proxies_.emplace(scene, own_runs_);
  add_guard(scene, own, own_);

  limits_.longer_p99 = std::max(goal_.most_longer, own_.longer_p99); // its own cloth is not to blame for the plan
  if (goal_.error == PlanError::body || goal_.error == PlanError::all) limits_.body = goal_.most;
  if (goal_.error == PlanError::trajectory) limits_.trajectory = goal_.most;
  if (goal_.error == PlanError::drape) limits_.drape = goal_.most;
  if (goal_.error == PlanError::all) {
    limits_.trajectory = own_.trajectory + goal_.most;
    limits_.drape = own_.drape + goal_.most;
  }
  hopeless_ = goal_.compares_bad ? std::numeric_limits<double>::infinity() : std::max(1.0, excess_of(own_, limits_));
}

LoadedScene PlanBench::scene_of(const PlanModel& model) {
  LoadedScene scene = with_setting(*scene_, model.setting);
  if (!scene.proxies.empty()) scene.proxies = proxies_->of(model, go_on_);
  return scene;
}

GarmentPositions PlanBench::start_of(const PlanModel& model) {
  const double resolution = model.setting.resolution;
  auto found = starts_.find(resolution);
  if (found == starts_.end())
    found = starts_.emplace(resolution, start_at_resolution(*scene_, start_, resolution)).first;
  return found->second;
}

PlanBench::Measured PlanBench::measure(const PlanModel& model) {
  const LoadedScene scene = scene_of(model);
  Measured result;
  // The guard first: it is short, and what it refuses needs no more.
  add_guard(scene, model, result.errors);
  if (excess_of(result.errors, limits_) > hopeless_) return result;
  const int every = std::max(1, static_cast<int>(scene.settings.frames_per_second / k_seldom));
  const double most = limits_.body ? k_far * hopeless_ * *limits_.body : std::numeric_limits<double>::infinity();
  const CellRun run = run_cell(scene, start_of(model), {goal_.frames, 0, 0, every}, true,
                               [&](const CellRun& so_far) { return so_far.surface_in_body <= most && go_on_(); });
  add_body(run, result.errors);
  result.errors.body *= k_between;
  result.cost = cost_of(run);
  return result;
}

PlanErrors PlanBench::verify(const PlanModel& model) {
  const LoadedScene scene = scene_of(model);
  PlanErrors errors;
  add_guard(scene, model, errors);
  for (const CellRun& run : run_starts(scene, model)) add_body(run, errors);
  return errors;
}

PlanBench::Pair PlanBench::compare(const PlanModel& first, const PlanModel& second, int pairs) {
  const LoadedScene scenes[] = {scene_of(first), scene_of(second)};
  const GarmentPositions starts[] = {start_of(first), start_of(second)};
  std::vector<double> medians[2], p99s[2], ratios;
  for (int k = 0; k < pairs && go_on_(); ++k) {
    PlanCost costs[2];
    for (int side = 0; side < 2; ++side) {
      const CellRun run = run_cell(scenes[side], starts[side], {goal_.frames, 0, 0, goal_.frames}, false,
                                   [&](const CellRun&) { return go_on_(); });
      costs[side] = cost_of(run);
      medians[side].push_back(costs[side].median);
      p99s[side].push_back(costs[side].p99);
    }
    ratios.push_back(costs[0].median / std::max(1e-9, costs[1].median));
  }
  if (ratios.empty()) return {};
  return {{median(medians[0]), median(p99s[0])}, {median(medians[1]), median(p99s[1])}, median(ratios)};
}

double PlanBench::skinning_ms() const {
  Session session(*scene_);
  std::vector<double> ms;
  double before = 0.0;
  for (int k = 0; k < k_skinned_poses; ++k) {
    session.skin_body();
    ms.push_back(session.times().skin - before);
    before = session.times().skin;
  }
  return median(std::move(ms));
}

void PlanBench::add_guard(const LoadedScene& scene, const PlanModel& model, PlanErrors& errors) {
  if (!reference_) return;
  const GarmentPositions start = start_of(model);
  LoadedScene seeded = scene;
  for (int k = 0; k < k_guard_starts; ++k, ++seeded.settings.seed) {
    const CellRun run = run_cell(seeded, start, guard_, false, [&](const CellRun&) { return go_on_(); });
    if (run.stopped) return;
    if (errors.trouble = trouble_of(run); !errors.trouble.empty()) return;
    const RunErrors e = errors_against(reference_garments_, reference_->trajectory, scene.garments, run.trajectory);
    errors.trajectory += e.trajectory_rms / k_guard_starts;
    errors.drape += e.drape_rms / k_guard_starts;
  }
}

std::vector<CellRun> PlanBench::run_starts(const LoadedScene& scene, const PlanModel& model) {
  const GarmentPositions start = start_of(model);
  std::vector<CellRun> runs(static_cast<std::size_t>(goal_.starts));
  Workers workers(std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, goal_.starts));
  workers.for_each(runs.size(), [&](std::size_t k) {
    LoadedScene seeded = scene;
    seeded.settings.seed += static_cast<int>(k);
    runs[k] = run_cell(seeded, start, {goal_.frames, 0, 0, 1}, true, [&](const CellRun&) { return go_on_(); });
  });
  return runs;
}

void PlanBench::add_body(const CellRun& run, PlanErrors& errors) {
  errors.body = std::max(errors.body, run.surface_in_body);
  errors.longer_p99 = std::max(errors.longer_p99, run.strains.longer.p99);
  errors.longer_max = std::max(errors.longer_max, run.strains.longer.max);
  if (errors.trouble.empty()) errors.trouble = trouble_of(run);
}

} // namespace tutu::app
