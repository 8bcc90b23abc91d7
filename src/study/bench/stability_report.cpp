#include "src/study/bench/stability_report.h"

#include "cloth/metrics.h"
#include "src/scene/load.h"
#include "src/study/bench/convergence.h"
#include "src/study/bench/cusick.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

using nlohmann::json;

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

json head_of(const std::string& name, const RunSettings& setup) {
  return {{"name", name},
          {"solver", cloth::name_of(setup.solver)},
          {"substeps", setup.substeps},
          {"adaptive_substeps", setup.adaptive_substeps},
          {"backend", proxies::k_backend_names[static_cast<std::size_t>(setup.backend)]},
          {"threads", 1}};
}

json json_of(const CrossingTally& tally) {
  return {{"frames", tally.frames}, {"worst", tally.worst}, {"total", tally.total}};
}

/// Of a variant's runs the longest thread and the deepest point that any ended with.
void worse_of(GarmentEnd& worst, const GarmentEnd& other) {
  worst.garment = other.garment;
  if (other.longest.longer > worst.longest.longer) worst.longest = other.longest;
  if (!worst.in_proxies || other.in_proxies->depth > worst.in_proxies->depth) worst.in_proxies = other.in_proxies;
}

/// The worst of a variant's runs.
struct Worst {
  StabilityRun run;
  int passed = 0, runs = 0;
  std::vector<std::string> broken;
  std::vector<double> ms;

  void add(const StabilityScene& scene, const StabilityRun& other, int start) {
    ++runs;
    const std::vector<std::string> why = broken_limits(scene, other);
    passed += why.empty();
    if (!why.empty()) broken.push_back(fmt::format("start {}: {}", start, fmt::join(why, "; ")));
    run.crossings += other.crossings;
    run.pierced += other.pierced;
    for (CrossingTally StabilityRun::*tally : {&StabilityRun::limbs, &StabilityRun::itself}) {
      (run.*tally).frames += (other.*tally).frames;
      (run.*tally).worst = std::max((run.*tally).worst, (other.*tally).worst);
      (run.*tally).total += (other.*tally).total;
    }
    run.recoveries += other.recoveries;
    for (double StabilityRun::*figure : {&StabilityRun::longer_p99, &StabilityRun::longer_max, &StabilityRun::depth,
                                         &StabilityRun::surface, &StabilityRun::deepest, &StabilityRun::speed})
      run.*figure = std::max(run.*figure, other.*figure);
    worse_of(run.left, other.left);
    run.most_substeps = std::max(run.most_substeps, other.most_substeps);
    ms.push_back(other.ms);
  }
};

void tell(const std::string& name, Worst& worst, std::uint64_t hash, StabilityReport& report) {
  const StabilityRun& run = worst.run;
  const double ms = cloth::percentile(worst.ms, 0.5);
  report.text +=
      fmt::format("{:<30}{:>3} of {} pass{:>7} crossings{:>7} pierced   longer p99 {:>6.2f} %   depth {:>5.2f} "
                  "mm, surface {:>5.2f} mm   {:>5.2f} m/s   {:>3} recoveries   {:>3} substeps at most   {:.2f} ms\n",
                  name, worst.passed, worst.runs, run.crossings, run.pierced, 100.0 * run.longer_p99, 1e3 * run.depth,
                  1e3 * run.surface, run.speed, run.recoveries, run.most_substeps, ms);
  const auto standing = [](const CrossingTally& tally) {
    return fmt::format("{} frames, {} places in one at worst, {} in all", tally.frames, tally.worst, tally.total);
  };
  if (run.limbs.frames > 0)
    report.text +=
        fmt::format("    stands in limbs in {}; {:.2f} mm deep at most\n", standing(run.limbs), 1e3 * run.deepest);
  if (run.itself.frames > 0) report.text += fmt::format("    stands in itself in {}\n", standing(run.itself));
  for (const std::string& why : worst.broken) report.text += fmt::format("    {}\n", why);
  report.json["variants"].push_back({{"name", name},
                                     {"runs", worst.runs},
                                     {"passed", worst.passed},
                                     {"crossings", run.crossings},
                                     {"pierced", run.pierced},
                                     {"through", {{"limbs", json_of(run.limbs)}, {"itself", json_of(run.itself)}}},
                                     {"longer_pct", {{"p99", 100.0 * run.longer_p99}, {"max", 100.0 * run.longer_max}}},
                                     {"pen_mm", {{"max", 1e3 * run.depth}}},
                                     {"surface_mm", {{"max", 1e3 * run.surface}}},
                                     {"deepest_mm", 1e3 * run.deepest},
                                     {"speed", run.speed},
                                     {"recoveries", run.recoveries},
                                     {"most_substeps", run.most_substeps},
                                     {"ms", {{"median", ms}}},
                                     {"broken", worst.broken},
                                     {"state_hash", hex(hash)}});
}

StabilityReport report_scenes(const StabilityFamily& family, const RunSettings& setup, int runs,
                              const std::function<bool()>& go_on) {
  StabilityReport report;
  report.json = head_of(family.name, setup);
  report.json["uneven_mm"] = 1e3 * k_stability_uneven;
  report.json["seeds"] = {{"first", 1}, {"last", runs}};
  report.text = fmt::format("{}: {}\n", family.name, family.what);
  report.passed = true;
  std::uint64_t all = cloth::state_hash({});
  for (const auto& build : family.variants) {
    Worst worst;
    std::string name;
    std::uint64_t hash = cloth::state_hash({});
    for (int start = 1; start <= runs && go_on(); ++start) {
      const StabilityScene scene = build(static_cast<std::uint64_t>(start));
      const StabilityRun run = run_stability(scene, setup, SurfaceLooks::every_frame);
      name = scene.name;
      worst.add(scene, run, start);
      hash = cloth::state_hash(run.end, hash);
      all = cloth::state_hash(run.end, all);
    }
    report.passed = report.passed && worst.passed == runs;
    if (worst.runs == 0) continue;
    tell(name, worst, hash, report);
    report.end.garments.push_back(worst.run.left);
  }
  report.json["end"] = report.end.json();
  report.json["state_hash"] = hex(all);
  return report;
}

StabilityReport report_figures(const AnalyticFamily& family, const RunSettings& setup) {
  StabilityReport report;
  report.json = head_of(family.name, setup);
  report.text = fmt::format("{}: {}\n", family.name, family.what);
  report.passed = true;
  cloth::Particles numbers;
  for (const AnalyticFigure& f : family.run(setup)) {
    report.passed = report.passed && f.passed();
    const bool judged = std::isfinite(f.tolerance);
    report.text +=
        fmt::format("{:<42}{:>12.6g} {:<4} {}   {}\n", f.what, f.measured, f.unit,
                    judged ? fmt::format("expected {:>10.6g} within {:.2g}", f.expected, f.tolerance) : "measured only",
                    !f.passed() ? "FAIL"
                    : judged    ? "pass"
                                : "");
    report.json["figures"].push_back({{"what", f.what},
                                      {"unit", f.unit},
                                      {"measured", f.measured},
                                      {"expected", judged ? json(f.expected) : json(nullptr)},
                                      {"tolerance", judged ? json(f.tolerance) : json(nullptr)},
                                      {"passed", f.passed()}});
    numbers.positions.emplace_back(f.measured, f.expected, f.tolerance);
  }
  report.json["state_hash"] = hex(cloth::state_hash(numbers));
  return report;
}

/// Those of formulas, and those that need more than cloth: the shipped fabrics, and runs to compare runs with.
std::vector<AnalyticFamily> figure_families() {
  std::vector<AnalyticFamily> families = analytic_families();
  families.push_back({"cusick", "the drape coefficient of every shipped fabric",
                      [](const RunSettings& setup) { return cusick(assets_folder() / "fabrics", setup); }});
  families.push_back({"convergence", "the order of the error in the step and in the cells, of a swinging sheet",
                      [](const RunSettings& setup) {
                        std::vector<AnalyticFigure> figures = convergence_in_step(setup);
                        const std::vector<AnalyticFigure> more = convergence_in_cells(setup);
                        figures.insert(figures.end(), more.begin(), more.end());
                        return figures;
                      }});
  return families;
}

} // namespace

std::vector<std::string> stability_names() {
  std::vector<std::string> names;
  for (const StabilityFamily& family : stability_families()) names.push_back(family.name);
  for (const AnalyticFamily& family : figure_families()) names.push_back(family.name);
  return names;
}

StabilityReport report_stability(const std::string& name, const RunSettings& setup, int runs,
                                 const std::function<bool()>& go_on) {
  StabilityReport report;
  for (const StabilityFamily& family : stability_families())
    if (family.name == name) report = report_scenes(family, setup, runs, go_on);
  for (const AnalyticFamily& family : figure_families())
    if (family.name == name) report = report_figures(family, setup);
  report.json["passed"] = report.passed;
  report.text += fmt::format("{}; state hash {}\n", report.passed ? "all pass" : "not all pass",
                             report.json.value("state_hash", ""));
  return report;
}

} // namespace tutu::app
