// tutu cell: one setting of a scene, one run, one row. What `tutu chart` starts many of.
#include "rig/error.h"
#include "src/base/interrupt.h"
#include "src/base/outputs.h"
#include "src/commands/commands.h"
#include "src/options/chart_options.h"
#include "src/options/scene_options.h"
#include "src/scene/load.h"
#include "src/study/chart/results_file.h"

#include <fmt/format.h>

namespace tutu::app {
namespace {

struct Options {
  ChartOptions chart;
  std::uint64_t seed = 0;
  std::string out, name;
  std::optional<std::string> solver, backend, proxies, features, adaptive, swept, precision, self_collision;
  std::optional<int> substeps, rate, passes, threads;
  std::optional<double> resolution;
};

Setting setting_for(const Options& o, const RunSettings& of_scene) {
  Setting s = own_setting(of_scene);
  if (o.solver) s.solver = cloth::solver_named(*o.solver);
  if (o.backend) s.backend = proxies::backend_named(*o.backend);
  if (o.substeps) s.substeps = *o.substeps;
  if (o.adaptive) s.adaptive_substeps = *o.adaptive == "on";
  if (o.rate) s.frames_per_second = *o.rate;
  if (o.resolution) s.resolution = *o.resolution;
  if (o.proxies) s.proxies = *o.proxies;
  if (o.features) s.features = cloth::contact_features_named(*o.features);
  if (o.swept) s.swept = *o.swept == "on";
  if (o.passes) s.passes = *o.passes;
  if (o.precision) s.double_precision = *o.precision == "on";
  if (o.self_collision) s.self_collision = *o.self_collision == "on";
  if (o.threads) s.threads = *o.threads;
  s.name = !o.name.empty() || !(s == own_setting(of_scene)) ? o.name : s.name;
  return s;
}

void print_row(const Row& row) {
  for (const std::string& column : row_columns())
    if (!row.text(column).empty()) fmt::print("{:<22}{}\n", column, row.text(column));
}

int run(const Options& options) {
  catch_interrupt();
  const LoadedScene base = options.chart.load();
  if (!options.out.empty() && !std::filesystem::exists(options.out)) // else rows are added to it
    check_outputs({{"--out", options.out}}, {});
  const ReferencePlan plan = options.chart.plan(base);
  const Setting setting = setting_for(options, base.settings);
  const LoadedScene scene = with_setting(base, setting);
  const Protocol protocol = at_rate(plan.protocol, base.settings.frames_per_second, scene.settings.frames_per_second);
  const auto reference = options.chart.obtain(base, 1);
  if (!reference) return k_not_met;

  const CellStart start{start_at_resolution(base, reference->start, setting.resolution), options.seed};
  const CellRun run = run_cell(scene, start, protocol, true, [](const CellRun&) { return !interrupted(); });
  if (run.stopped) {
    fmt::print(stderr, "tutu: interrupted; no row written\n");
    return k_not_met;
  }
  const LoadedScene truth = with_setting(base, reference_setting(base, plan, reference->substeps));
  const CellTask task{base.name(), reference->fingerprint, plan.protocol, setting, options.seed};
  const Row row =
      row_of(scene, task, run, errors_against(truth.garments, reference->trajectory, scene.garments, run.trajectory));
  if (options.out.empty()) print_row(row);
  else add_row(options.out, row);
  return run.failure.empty() ? k_ok : k_not_met;
}

} // namespace

void add_cell(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("cell", "Measure one setting of a scene against its reference: one row");
  auto o = std::make_shared<Options>();
  o->chart.add_to(*command);
  const CLI::Validator on_off = CLI::IsMember({"on", "off"});
  const std::string group = "Setting, in place of the scene's";
  const auto option = [&](const char* name, auto& value, const char* text) {
    return command->add_option(name, value, text)->group(group);
  };
  option("--solver", o->solver, "What moves the cloth")->check(one_of(cloth::k_solver_names));
  option("--backend", o->backend, "How particles ask colliders")->check(one_of(proxies::k_backend_names));
  option("--substeps", o->substeps, "Substeps a frame")->check(CLI::Range(1, 10000));
  option("--adaptive-substeps", o->adaptive, "More of them where something moves too fast")->check(on_off);
  option("--frames-per-second", o->rate, "Frames a second")->check(CLI::Range(1, 10000));
  option("--resolution", o->resolution, "Times the scene's cells along each side of its garments")
      ->check(finite_number())
      ->check(CLI::Range(0.01, 100.0));
  option("--proxies", o->proxies, "A proxies file, or none");
  option("--features", o->features, "What of the cloth meets colliders")
      ->check(one_of(cloth::k_contact_features_names));
  option("--swept", o->swept, "Contacts by time of impact where something moves far")->check(on_off);
  option("--passes", o->passes, "Passes over the constraints, a substep")->check(CLI::Range(1, 100));
  option("--double-precision", o->precision, "Of the solver's kernels")->check(on_off);
  option("--self-collision", o->self_collision, "Of each garment with itself")->check(on_off);
  option("--threads", o->threads, "Threads that step garments side by side")->check(CLI::Range(1, k_most_threads));
  command->add_option("--name", o->name, "What the row is called");
  command->add_option("--seed", o->seed, "Of the start's jitter; 0: none")->capture_default_str();
  command->add_option("-o,--out", o->out, "Add the row to this file (.csv); printed when left out");
  command->callback([o, &status] { status = run(*o); });
}

} // namespace tutu::app
