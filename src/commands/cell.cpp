// tutu cell: one setting of a scene, one run, one row. What `tutu chart` starts many of.
#include "rig/error.h"
#include "src/base/interrupt.h"
#include "src/base/outputs.h"
#include "src/commands/commands.h"
#include "src/options/chart_options.h"
#include "src/options/scene_options.h"
#include "src/options/setting_options.h"
#include "src/scene/load.h"
#include "src/study/chart/results_file.h"

#include <fmt/format.h>

namespace tutu::app {
namespace {

struct Options {
  ChartOptions chart;
  std::string out, name;
  std::vector<SettingChange> changes;
  std::optional<std::string> proxies;
  std::optional<double> resolution;
};

Setting setting_for(const Options& o, const Scene& scene) {
  Setting s = own_setting(scene.settings);
  for (const SettingChange& change : o.changes) change.row->set(s, change.value);
  for (const SettingChange& change : o.changes)
    if (const auto wrong = unhonoured(*change.row, s, scene.garments))
      throw InputError("", change.by, wrong->found, wrong->expected);
  if (o.resolution) s.resolution = *o.resolution;
  if (o.proxies) s.proxies = *o.proxies;
  Setting own = own_setting(scene.settings);
  own.seed = s.seed; // another start is no other setting
  s.name = !o.name.empty() || !(s == own) ? o.name : s.name;
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
  const Setting setting = setting_for(options, base);
  const LoadedScene scene = with_setting(base, setting);
  const Protocol protocol = at_rate(plan.protocol, base.settings.frames_per_second, scene.settings.frames_per_second);
  const auto reference = options.chart.obtain(base, 1);
  if (!reference) return k_not_met;

  const GarmentPositions start = start_at_resolution(base, reference->start, setting.resolution);
  const CellRun run = run_cell(scene, start, protocol, true, [](const CellRun&) { return !interrupted(); });
  if (run.stopped) {
    fmt::print(stderr, "tutu: interrupted; no row written\n");
    return k_not_met;
  }
  const LoadedScene truth = with_setting(base, reference_setting(base, plan, reference->substeps));
  const CellTask task{base.name(), reference->fingerprint, plan.protocol, setting};
  const Row row =
      row_of(scene, task, run, errors_against(truth.garments, reference->trajectory, scene.garments, run.trajectory));
  if (options.out.empty()) print_row(row);
  else add_row(options.out, row);
  print_warning(run.end.warning());
  return run.failure.empty() ? k_ok : k_not_met;
}

} // namespace

void add_cell(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("cell", "Measure one setting of a scene against its reference: one row");
  auto o = std::make_shared<Options>();
  o->chart.add_to(*command);
  add_setting_options(*command, o->changes);
  command->add_option("--resolution", o->resolution, "Times the scene's cells along each side of its garments")
      ->check(finite_number())
      ->check(CLI::Range(0.01, 100.0));
  command->add_option("--proxies", o->proxies, "A proxies file, or none, in place of the scene's");
  command->add_option("--name", o->name, "What the row is called");
  command->add_option("-o,--out", o->out, "Add the row to this file (.csv); printed when left out");
  command->callback([o, &status] { status = run(*o); });
}

} // namespace tutu::app
