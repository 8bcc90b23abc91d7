// tutu plan: the least model of a scene that meets a stated error, as a scene of its own.
#include "cloth/garment/drape_file.h"
#include "proxies/proxy_file.h"
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "src/base/json_text.h"
#include "src/base/outputs.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/measure/uneven_json.h"
#include "src/options/chart_options.h"
#include "src/options/scene_options.h"
#include "src/run/drape.h"
#include "src/run/posed_body.h"
#include "src/run/session.h"
#include "src/scene/load.h"
#include "src/scene/scene_write.h"
#include "src/study/plan/plan_report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  ChartOptions chart; ///< of which the scene and the reference are asked for here
  double error_mm = 0.0, longer_percent = 5.0;
  std::optional<double> ms;
  std::string error = "all", out, json;
  std::optional<int> frames;
  int starts = 3;
};

constexpr int k_pairs = 3;       // runs of each of two models whose cost is compared, and
constexpr int k_final_pairs = 5; // of what is reported in the end

PlanGoal goal_of(const Options& options, const LoadedScene& scene) {
  PlanGoal goal;
  goal.error = static_cast<PlanError>(std::find(k_plan_error_names.begin(), k_plan_error_names.end(), options.error) -
                                      k_plan_error_names.begin());
  goal.most = 1e-3 * options.error_mm;
  goal.most_longer = 1e-2 * options.longer_percent;
  goal.frames = std::min(options.frames.value_or(k_most_frames), frames_of(scene));
  goal.starts = options.starts;
  goal.compares_bad = options.ms.has_value();
  if (goal.frames == 0) throw InputError(scene.file, "/motion", "one pose", "a motion");
  return goal;
}

/// Whether the scene's garments can have other cells: meshes cannot.
bool regrids(const LoadedScene& scene) {
  Setting setting = own_setting(scene.settings);
  setting.resolution = 2.0;
  try {
    const LoadedScene other = with_setting(scene, setting);
    return !other.garments.empty();
  } catch (const InputError&) {
    return false;
  }
}

/// How many measurements a search takes that finds nothing to mend.
int usual_steps(const std::vector<PlanChoice>& choices) {
  int steps = 3;
  for (const PlanChoice& choice : choices)
    if (choice.own > 0) steps += 1 + static_cast<int>(std::ceil(std::log2(choice.own + 1)));
  return steps;
}

PlanRecord search(const LoadedScene& scene, PlanBench& bench, const Options& options) {
  PlanRecord record;
  record.choices = choices_of(scene.settings, !scene.proxies.empty(), regrids(scene));
  std::vector<PlanAxis> axes;
  for (const PlanChoice& choice : record.choices) axes.push_back(choice.axis());
  const auto model = [&](const PlanLevels& levels) { return model_of(scene.settings, record.choices, levels); };
  Progress bar("plan", usual_steps(record.choices));
  int done = 0;
  PlanMeasurer measurer;
  measurer.measure = [&](const PlanLevels& levels) {
    const PlanBench::Measured measured = bench.measure(model(levels));
    record.tried[levels] = record.errors[levels] = measured.errors;
    bar.tick(++done);
    return PlanFigures{excess_of(measured.errors, bench.limits()), measured.cost.median};
  };
  measurer.verify = [&](const PlanLevels& levels) {
    const PlanErrors errors = bench.verify(model(levels));
    if (!interrupted()) record.errors[levels] = errors;
    bar.tick(++done);
    return excess_of(errors, bench.limits());
  };
  measurer.cost_ratio = [&](const PlanLevels& levels, const PlanLevels& other) {
    const PlanBench::Pair pair = bench.compare(model(levels), model(other), k_pairs);
    record.costs[{levels, other}] = pair;
    bar.tick(++done);
    return pair.ratio;
  };
  measurer.go_on = [] { return !interrupted(); };
  record.result = find_plan(axes, measurer, options.ms);
  PlanModel own; // with the proxies that are out of reach
  own.setting = own_setting(scene.settings);
  if (!interrupted()) record.cost = bench.compare(model(record.result.levels), own, k_final_pairs);
  return record;
}

/// The scene, and beside it its proxies and the start it was measured from, that it plays as it was measured.
void write_plan(const LoadedScene& scene, PlanBench& bench, PlanRecord& record, const Options& options) {
  const fs::path file = options.out;
  const PlanModel model = model_of(scene.settings, record.choices, record.result.levels);
  const LoadedScene planned = bench.scene_of(model);
  SceneDescription description = planned.description();
  description.drape = fs::path(file).replace_extension(".drape.json");
  description.settings.uneven_mm =
      read_scene(options.chart.scene_file()).settings.uneven_mm; // that of a chart is not its own
  for (const proxies::Proxy& proxy : planned.proxies) record.kept.push_back(proxy.name);
  if (!scene.proxies.empty()) record.proxies = bench.proxies().uses(model);
  description.proxies.reset();
  if (!planned.proxies.empty()) {
    description.proxies = fs::path(file).replace_extension(".proxies.json");
    proxies::write_proxies(*description.proxies, planned.proxies, scene.character.skeleton);
  }
  write_scene(description, file,
              fmt::format("tutu plan of {}, error \"{}\" of {:g} mm", scene.name(), options.error, options.error_mm));
  const LoadedScene written = load_scene(read_scene(file));
  cloth::Drape drape{drape_fingerprint(written), {}};
  const GarmentPositions start = bench.start_of(model);
  for (std::size_t g = 0; g < start.size(); ++g) drape.garments.push_back({written.garments[g].name, start[g]});
  cloth::write_drape(drape, description.drape);
}

/// A place to write to is looked for before the long work.
void check_out(const Options& options, const LoadedScene& scene) {
  const fs::path file = options.out;
  if (file.extension() != ".json") throw InputError("", "--out", file.string(), "a file name that ends in .json");
  const std::vector<Output> outputs = {{"--out", file},
                                       {"the plan's drape", fs::path(file).replace_extension(".drape.json")},
                                       {"the plan's proxies", fs::path(file).replace_extension(".proxies.json")},
                                       {"--json", options.json}};
  check_outputs(outputs, inputs_of(scene.files));
}

int run(Options options) {
  catch_interrupt();
  options.chart.quick = true;
  const LoadedScene scene = options.chart.load();
  if (options.out.empty()) options.out = scene.name() + "-plan.json";
  check_out(options, scene);
  const PlanGoal goal = goal_of(options, scene);
  const ReferencePlan plan = options.chart.plan(scene);
  std::optional<Reference> reference;
  std::optional<GarmentPositions> start;
  if (goal.error != PlanError::body) {
    reference = options.chart.obtain(scene, 1);
    if (reference) start = reference->start;
  } else {
    start = draped_start(scene);
  }
  if (!start) return k_not_met;

  PlanBench bench(scene, goal, plan, std::move(reference), *start, [] { return !interrupted(); });
  if (interrupted()) {
    fmt::print(stderr, "tutu: interrupted before the scene itself was measured; nothing written\n");
    return k_not_met;
  }
  fmt::print(stderr, "{}", goal_text(goal, bench.limits()));
  PlanRecord record = search(scene, bench, options);
  record.skinning_ms = bench.skinning_ms();
  record.skin_needed = scene.settings.backend == proxies::Backend::mesh;
  for (const SkinPins& pins : scene.skin_pins) record.skin_needed = record.skin_needed || !pins.bindings.empty();
  write_plan(scene, bench, record, options);
  fmt::print("{}wrote {}\n", plan_text(scene.name(), record, goal, bench.limits(), options.ms), options.out);
  if (!options.json.empty()) {
    nlohmann::ordered_json json = plan_json(scene.name(), record, goal, bench.limits(), options.ms);
    json["own"] = errors_json(bench.own());
    json.update(uneven_json(scene.settings));
    json["out"] = options.out;
    write_file(options.json, json_text(json));
  }
  return record.result.good && record.result.in_budget ? k_ok : k_not_met;
}

} // namespace

void add_plan(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("plan", "Find the least model of a scene that meets a stated error");
  auto o = std::make_shared<Options>();
  command->add_option("scene", o->chart.scene, "Scene file (.json); the shipped dance when left out");
  command->add_option("--error-mm", o->error_mm, "The error that is allowed")
      ->required()
      ->check(finite_number())
      ->check(CLI::Range(1e-3, 1e4));
  command
      ->add_option("--error", o->error,
                   "Which error that is. body: the deepest that free cloth is inside of the true body over the motion. "
                   "trajectory: RMS distance from the reference in the first second. drape: RMS distance from its "
                   "settled shape. all: body, and neither of the others gets worse than the scene's own by more")
      ->check(CLI::IsMember(std::vector<std::string>(k_plan_error_names.begin(), k_plan_error_names.end())))
      ->capture_default_str();
  command->add_option("--ms", o->ms, "Most ms a frame, median; what takes more gives way to the best within it")
      ->check(finite_number())
      ->check(CLI::Range(1e-6, 1e6));
  command
      ->add_option("--longer-percent", o->longer_percent,
                   "99 % of the threads are at most so much longer, or as much as in the scene itself")
      ->check(finite_number())
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  command->add_option("--frames", o->frames, "Frames of motion; all of it when left out")
      ->check(CLI::Range(1, k_most_frames));
  command->add_option("--starts", o->starts, "Uneven starts the plan is verified from, each with another seed")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command
      ->add_option("--reference-substeps", o->chart.reference_substeps,
                   "Substeps a frame of the reference and of the coarser runs that show it converged, rising")
      ->delimiter(',')
      ->check(CLI::Range(1, 10000));
  command->add_option("--cache", o->chart.cache,
                      "Folder that keeps references (default: $XDG_CACHE_HOME/tutu or ~/.cache/tutu)");
  command->add_option("--reference", o->chart.reference,
                      "This reference file (of tutu chart --quick) instead of the cache's");
  command->add_option("-o,--out", o->out,
                      "Scene to write (.json; SCENE-plan.json when left out), with its proxies and drape beside it");
  command->add_option("--json", o->json, "Write the choices and figures for machines");
  command->callback([o, &status] { status = run(*o); });
}

} // namespace tutu::app
