// tutu validate: how far a scene's proxies, and its cloth, are from the true body.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "src/base/json_text.h"
#include "src/base/outputs.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/measure/validation.h"
#include "src/options/scene_options.h"
#include "src/scene/load.h"
#include "src/study/report/validation_html.h"
#include "src/view/show/heat_maps.h"

#include <algorithm>
#include <fmt/format.h>
#include <thread>

namespace tutu::app {
namespace {

struct Options {
  SceneOptions scene;
  int every = 1, samples = ValidationOptions().samples;
  std::optional<double> tolerance_mm;
  std::string judge = std::string(k_judge_names[0]);
  bool reach = false, no_cloth = false;
  std::string json, html;
};

Judge judge_named(const std::string& name) {
  return static_cast<Judge>(std::find(k_judge_names.begin(), k_judge_names.end(), name) - k_judge_names.begin());
}

int run(const Options& options) {
  catch_interrupt();
  const LoadedScene scene = options.scene.load();
  check_outputs({{"--json", options.json}, {"--html", options.html}}, inputs_of(scene.files));
  if (options.reach && scene.garments.empty())
    throw InputError("", "--reach", scene.file + " without garments", "a scene with garments");

  ValidationOptions what;
  what.every = options.every;
  what.samples = options.samples;
  if (options.tolerance_mm) what.tolerance = 1e-3 * *options.tolerance_mm;
  what.threads = options.scene.threads().value_or(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  std::optional<GarmentPositions> start;
  if (!options.no_cloth && !scene.garments.empty()) {
    start = draped_start(scene);
    if (!start) return k_not_met;
  }

  Progress bar("validating " + scene.name(), frames_to_measure(scene, what.every));
  const Validation validation = validate(scene, what, start, [&](int done, int) {
    bar.tick(done);
    return !interrupted();
  });
  bar.finish();
  if (const auto note = proxies::note_of(validation.census);
      note && !scene.collides_with_body()) // else said when loaded
    fmt::print(stderr, "note: {}: {}\n", scene.files.character.filename().string(), *note);
  std::optional<Verdict> verdict;
  if (options.tolerance_mm)
    verdict = judge(validation, 1e-3 * *options.tolerance_mm, judge_named(options.judge), options.reach);

  std::string no_maps;
  std::vector<HeatMap> maps;
  if (!options.html.empty() && !validation.stopped) {
    std::vector<int> frames;
    for (const int f : validation.worst_frames) frames.push_back(validation.frames[f].frame);
    maps = heat_maps(
        scene, frames, ErrorScale::of(what.tolerance), [] { return !interrupted(); }, no_maps);
  }
  if (validation.stopped || interrupted()) {
    fmt::print(stderr, "tutu: interrupted after {} frames; nothing written\n", validation.frames.size());
    return k_not_met;
  }
  if (!options.html.empty()) write_file(options.html, validation_html(validation, scene, verdict, maps, no_maps));
  if (!options.json.empty()) write_file(options.json, json_text(validation_json(validation, scene, verdict)));
  fmt::print("{}", validation_text(validation, scene, verdict));
  if (!options.html.empty()) fmt::print("wrote {}\n", options.html);
  if (validation.cloth_failure) fmt::print(stderr, "tutu: {}\n", *validation.cloth_failure);
  if (validation.cloth) print_warning(validation.cloth->end.warning());
  return validation.cloth_failure || (verdict && !verdict->met()) ? k_not_met : k_ok;
}

} // namespace

void add_validate(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "validate", "Measure a scene's proxies, and its cloth, against the true skinned body over the whole motion");
  auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command->get_option("--threads")->description("Threads that measure frames side by side; all when left out");
  command->add_option("--every", options->every, "Measure every so many frames only")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--samples", options->samples, "Points on the skin, about; the proxies get a fifth of them")
      ->check(CLI::Range(100, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--tolerance-mm", options->tolerance_mm,
                   "Exit with 1 unless both sides keep to this; also what counts as covered (10 when left out)")
      ->check(finite_number())
      ->check(CLI::Range(0.001, 1000.0));
  command
      ->add_option("--judge", options->judge,
                   "What is held against the tolerance: max (the bound: no point is farther out), p99 or p95")
      ->check(one_of(k_judge_names))
      ->capture_default_str();
  command->add_flag("--reach", options->reach, "Judge only what the garments can reach");
  command->add_flag("--no-cloth", options->no_cloth, "Do not simulate the garments");
  command->add_option("--json", options->json, "Write all figures to this file");
  command->add_option("--html", options->html, "Write a report for people to this file: one page, no network needed");
  command->callback([options, &status] { status = run(*options); });
}

} // namespace tutu::app
