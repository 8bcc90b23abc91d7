#include "src/options/chart_options.h"

#include "cloth/garment/uneven.h"
#include "rig/error.h"
#include "src/base/interrupt.h"
#include "src/options/scene_options.h"
#include "src/run/posed_body.h"
#include "src/scene/load.h"
#include "src/study/chart/settings_grid.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <numeric>

namespace tutu::app {
namespace {

/// Whole frames at the scene's rate and at the report's, that all settings are compared at the same moments (of a rate
/// with fractions the report's is as far from its own whole rate: report_setting).
Protocol usual_protocol(double rate, int frames_of_motion, bool quick) {
  const int whole_rate = static_cast<int>(std::lround(rate));
  const int unit = whole_rate / std::gcd(whole_rate, k_report_rate); // frames
  const auto whole = [&](double seconds) { return unit * std::max(1, static_cast<int>(seconds * rate / unit + 1e-9)); };
  if (quick) return {std::min(whole(k_trajectory_seconds), frames_of_motion), whole(0.5), whole(0.35), 2 * unit};
  return {std::max(unit, frames_of_motion / unit * unit), whole(1.0), whole(1.0), unit};
}

const std::vector<int> k_quick_substeps = {12, 24, 48};

} // namespace

void ChartOptions::add_to(CLI::App& command) {
  command.add_option("scene", scene, "Scene file (.json); the shipped dance when left out");
  command.add_flag("--quick", quick, "The first second of the motion, and a coarser reference");
  command.add_option("--frames", frames, "Frames of motion; all of it when left out")->check(CLI::Range(1, 1'000'000));
  command.add_option("--settle", settle, "Frames after it in which the cloth settles on the last pose")
      ->check(CLI::Range(0, 1'000'000));
  command.add_option("--held", held, "Frames after that in which the pose is held, for jitter and drift")
      ->check(CLI::Range(0, 1'000'000));
  command.add_option("--every", every, "Compare and measure against the body every so many frames")
      ->check(CLI::Range(1, 1'000'000));
  command
      .add_option("--reference-substeps", reference_substeps,
                  "Substeps a frame of the reference and of the coarser runs that show it converged, rising")
      ->delimiter(',')
      ->check(CLI::Range(1, 10000));
  command
      .add_option("--reference-resolution", reference_resolution, "Times the scene's cells a side, in the reference")
      ->check(finite_number())
      ->check(CLI::Range(0.01, 100.0));
  command.add_option("--cache", cache, "Folder that keeps references (default: $XDG_CACHE_HOME/tutu or ~/.cache/tutu)");
  command.add_option("--reference", reference, "This reference file instead of the cache's");
}

std::filesystem::path ChartOptions::scene_file() const {
  return scene.empty() ? assets_folder() / "scenes" / "dance.json" : std::filesystem::path(scene);
}

LoadedScene ChartOptions::load() const {
  LoadedScene loaded = load_scene(read_scene(scene_file()));
  for (const std::string& note : loaded.notes) fmt::print(stderr, "note: {}\n", note);
  if (loaded.garments.empty()) throw InputError(loaded.file, "/garments", "none", "garments to measure");
  if (loaded.settings.uneven_mm == 0.0) loaded.settings.uneven_mm = 1e3 * cloth::k_unevenness;
  return loaded;
}

ReferencePlan ChartOptions::plan(const LoadedScene& loaded) const {
  ReferencePlan plan;
  if (quick) plan.substeps = k_quick_substeps;
  plan.protocol = usual_protocol(loaded.settings.frames_per_second, frames_of(loaded), quick);
  Protocol& p = plan.protocol;
  p = {frames.value_or(p.frames), settle.value_or(p.settle), held.value_or(p.held), every.value_or(p.every)};
  if (!reference_substeps.empty()) plan.substeps = reference_substeps;
  if (plan.substeps.size() < 3 || !std::is_sorted(plan.substeps.begin(), plan.substeps.end(), std::less_equal<>()))
    throw InputError("", "--reference-substeps", fmt::format("{}", fmt::join(plan.substeps, ",")),
                     "at least three, rising: a reference that was refined twice");
  if (reference_resolution) plan.resolution = *reference_resolution;
  return plan;
}

std::optional<Reference> ChartOptions::obtain(const LoadedScene& loaded, int jobs) const {
  const ReferencePlan plan = this->plan(loaded);
  if (!reference.empty()) return reference_from(reference, loaded, plan);
  const auto made = obtain_reference(
      loaded, plan, cache.empty() ? default_cache() : std::filesystem::path(cache), jobs,
      [&] { return draped_start(loaded); }, [] { return !interrupted(); });
  if (!made && interrupted())
    fmt::print(stderr, "tutu: interrupted before the reference was whole; refinements that are done are kept\n");
  return made;
}

std::vector<std::string> ChartOptions::words() const {
  std::vector<std::string> words = {scene_file().string()};
  const auto add = [&](const char* name, const std::string& value) { words.insert(words.end(), {name, value}); };
  if (quick) words.emplace_back("--quick");
  if (frames) add("--frames", std::to_string(*frames));
  if (settle) add("--settle", std::to_string(*settle));
  if (held) add("--held", std::to_string(*held));
  if (every) add("--every", std::to_string(*every));
  if (!reference_substeps.empty()) add("--reference-substeps", fmt::format("{}", fmt::join(reference_substeps, ",")));
  if (reference_resolution) add("--reference-resolution", fmt::format("{}", *reference_resolution));
  if (!cache.empty()) add("--cache", cache);
  if (!reference.empty()) add("--reference", reference);
  return words;
}

} // namespace tutu::app
