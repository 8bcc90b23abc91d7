// tutu chart: speed against accuracy of many settings of one scene.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "src/base/outputs.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/options/chart_options.h"
#include "src/scene/load.h"
#include "src/study/chart/chart_page.h"
#include "src/study/chart/chart_picture.h"
#include "src/study/chart/results_file.h"
#include "src/study/chart/settings_grid.h"
#include "src/study/chart/slurm_array.h"
#include "src/study/report/gnuplot_chart.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>
#include <thread>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  ChartOptions chart;
  std::string out, settings;
  std::vector<std::string> merge;
  bool slurm = false;
  int jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  int repeats = 0; ///< 0: as many as built in
};

constexpr int k_repeats = 3, k_quick_repeats = 2;

/// Makes the files of proxies that are only a number so far, in the folder of the results, by `tutu fit`.
void make_fitted(std::vector<Setting>& settings, const LoadedScene& scene, const fs::path& folder, int jobs) {
  std::vector<std::vector<std::string>> calls;
  std::set<std::string> asked;
  for (Setting& setting : settings) {
    const auto count = fitted_count(setting);
    if (!count) continue;
    const fs::path file = folder / fmt::format("proxies-{}.json", *count);
    setting.proxies = file.string();
    if (fs::exists(file) || !asked.insert(setting.proxies).second) continue;
    const auto* motion = std::get_if<ClipMotion>(&scene.files.motion);
    if (!motion || motion->retarget_from)
      throw InputError(scene.file, "/motion", "one that tutu fit does not take",
                       "a clip of this character, for settings with a number of proxies");
    calls.push_back({"fit", scene.files.character.string(), "--motion", motion->clip.string(), "--region", "body",
                     "--count", std::to_string(*count), "--under-weight", "12", "--out", file.string()});
  }
  Progress bar("fitting proxies", static_cast<int>(calls.size()));
  int done = 0;
  std::string trouble;
  run_processes(
      calls, jobs,
      [&](std::size_t, const ProcessEnd& end) {
        if (!end.good() && !interrupted()) trouble = end.last_message();
        bar.tick(++done);
      },
      [] { return !interrupted(); });
  if (!trouble.empty()) throw std::runtime_error("proxies could not be fitted: " + trouble);
}

/// Each setting from each start: all settings once before any twice.
std::vector<CellTask> tasks_of(const std::vector<Setting>& settings, int repeats, const CellTask& like) {
  std::vector<CellTask> tasks;
  for (int k = 0; k < repeats; ++k)
    for (const Setting& setting : settings) {
      CellTask& task = tasks.emplace_back(like);
      task.setting = setting;
      task.setting.seed += k;
    }
  return tasks;
}

/// Where the row of a task goes. On a cluster each has a file of its own: not every shared disk knows how to let only
/// one write.
fs::path row_file(const Options& options, const CellTask& task) {
  const fs::path folder = options.out;
  return options.slurm ? folder / "slurm" / (cell_key(task) + ".csv") : folder / "results.csv";
}

std::vector<std::string> call_of(const Options& options, const CellTask& task, const SettingValues& of_scene) {
  std::vector<std::string> words = options.chart.words();
  words.insert(words.begin(), "cell");
  for (const std::string& word : setting_options(setting_values(task.setting), of_scene)) words.push_back(word);
  if (!task.setting.name.empty()) words.push_back("--name=" + task.setting.name); // it may begin with -
  words.insert(words.end(), {"--seed", std::to_string(task.setting.seed), "--out", row_file(options, task).string()});
  return words;
}

/// Rows of other machines, and of a cluster's jobs that ended after the chart that asked for them.
void merge_others(const Options& options, const fs::path& file) {
  for (const std::string& other : options.merge) {
    fmt::print(stderr, "note: {} rows of {} are new\n", merge_rows(other, file), other);
  }
  if (!fs::exists(fs::path(options.out) / "slurm")) return;
  for (const auto& entry : fs::directory_iterator(fs::path(options.out) / "slurm"))
    if (entry.path().extension() == ".csv") merge_rows(entry.path(), file);
}

/// Runs what has no row yet. False when interrupted.
bool run_missing(const Options& options, const std::vector<CellTask>& tasks, const SettingValues& of_scene) {
  const fs::path file = fs::path(options.out) / "results.csv";
  merge_others(options, file);
  const Results before = read_results(file);
  for (const std::string& note : before.notes) fmt::print(stderr, "note: {}\n", note);
  std::set<std::string> done;
  for (const Row& row : before.rows)
    if (row.text("outcome") != k_crashed) done.insert(row.text("key"));
  std::vector<CellTask> missing;
  std::vector<std::vector<std::string>> calls;
  for (const CellTask& task : tasks)
    if (!done.contains(cell_key(task))) {
      missing.push_back(task);
      calls.push_back(call_of(options, task, of_scene));
    }
  if (missing.size() < tasks.size())
    fmt::print(stderr, "note: {} of {} runs are in {} already\n", tasks.size() - missing.size(), tasks.size(),
               file.string());
  Progress bar("chart", static_cast<int>(missing.size()));
  int ended = 0, crashes = 0;
  const auto on_end = [&](std::size_t k, const ProcessEnd& end) {
    const bool wrote_row = end.signal == 0 && (end.status == k_ok || end.status == k_not_met);
    if (wrote_row && options.slurm) merge_rows(row_file(options, missing[k]), file);
    if (!wrote_row && !interrupted()) {
      add_row(file, row_of_crash(missing[k], end.signal != 0 ? fmt::format("killed by signal {}", end.signal)
                                                             : end.last_message()));
      ++crashes;
    }
    bar.tick(++ended);
  };
  const auto go_on = [] { return !interrupted(); };
  if (options.slurm) run_slurm_array(calls, fs::path(options.out) / "slurm", on_end, go_on);
  else run_processes(calls, options.jobs, on_end, go_on);
  bar.finish();
  if (options.slurm && crashes == 0 && go_on()) fs::remove_all(fs::path(options.out) / "slurm"); // else for its logs
  return go_on();
}

/// Rows measured against this reference; without those of a proxies file that has changed since.
std::vector<Row> rows_to_draw(const fs::path& file, const std::vector<CellTask>& tasks) {
  std::map<std::pair<SettingValues, std::string>, std::string> keys; // by setting and seed
  for (const CellTask& task : tasks)
    keys.emplace(std::pair(setting_values(task.setting), std::to_string(task.setting.seed)), cell_key(task));
  std::vector<Row> rows;
  for (const Row& row : read_results(file).rows) {
    const auto now = keys.find({row.setting(), row.text("seed")});
    const bool is_stale = now != keys.end() && now->second != row.text("key");
    if (row.text("reference") == tasks.front().reference && !is_stale) rows.push_back(row);
  }
  return rows;
}

int run(const Options& options) {
  const fs::path folder = options.out;
  require_chart(folder / "chart.svg");
  if (options.slurm) require_slurm();
  for (const std::string& other : options.merge) { // told before long work
    if (!fs::exists(other)) throw InputError(other, "", "no such file", "rows of tutu cell or tutu chart (.csv)");
    (void)read_results(other);
  }
  catch_interrupt();
  const LoadedScene scene = options.chart.load();
  check_outputs({{"--out", folder, true}}, inputs_of(scene.files));
  const FolderLock lock(folder, "tutu chart");
  std::vector<Setting> settings = options.settings.empty() ? builtin_settings(scene.description(), options.chart.quick)
                                                           : read_settings(options.settings, scene.settings);
  if (options.settings.empty()) std::erase_if(settings, [&](const Setting& s) { return unhonoured(s, scene); });
  const ReferencePlan plan = options.chart.plan(scene);
  for (const Setting& setting : settings)
    if (const auto wrong = unhonoured(setting, scene))
      throw InputError(options.settings, setting.name, wrong->found, wrong->expected);
  for (const Setting& setting : settings)
    (void)at_rate(plan.protocol, scene.settings.frames_per_second, setting.frames_per_second);
  read_results(folder / "results.csv"); // a file of something else is told before long work
  make_fitted(settings, scene, folder, options.jobs);
  const auto reference = interrupted() ? std::nullopt : options.chart.obtain(scene, options.jobs);
  if (!reference) return k_not_met;
  fmt::print("{}", convergence_text(*reference));

  const int repeats = options.repeats > 0 ? options.repeats : options.chart.quick ? k_quick_repeats : k_repeats;
  const SettingValues of_scene = setting_values(own_setting(scene.settings));
  const std::vector<CellTask> tasks =
      tasks_of(settings, repeats, {scene.name(), reference->fingerprint, plan.protocol, {}});
  const bool whole = run_missing(options, tasks, of_scene);

  const std::vector<Row> rows = rows_to_draw(folder / "results.csv", tasks);
  if (!whole) {
    fmt::print(stderr, "tutu: interrupted with {} of {} runs done; the same command goes on from there\n", rows.size(),
               tasks.size());
    return k_not_met;
  }
  const std::vector<ChartPoint> points = points_of(rows, of_scene);
  for (const ErrorAxis& axis : error_axes())
    for (const char* extension : {"svg", "png"})
      write_chart_picture(points, axis, scene.name(), folder / fmt::format("chart-{}.{}", axis.stem, extension));
  const std::string verdict = default_verdict(points);
  write_file(folder / "chart.html", chart_page(points, *reference, verdict, options.chart.words(), of_scene));
  fmt::print("{}{}wrote results.csv, chart.html and chart-*.svg and .png in {}/\n", points_text(points), verdict,
             folder.string());
  return k_ok;
}

} // namespace

void add_chart(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "chart", "Chart speed against accuracy: many settings of a scene against a converged reference");
  auto options = std::make_shared<Options>();
  options->chart.add_to(*command);
  command->get_option("--quick")->description(
      "A first look, in a minute on two cores: the first second of the motion, fewer settings, a coarser reference");
  command->add_option("-o,--out", options->out, "Folder for results.csv, chart.html and the pictures")->required();
  command->add_option("--settings", options->settings, "Settings to chart (.json) instead of the built-in ones");
  command->add_option("--jobs", options->jobs, "Runs at a time")->check(CLI::Range(1, 1024))->capture_default_str();
  command->add_flag("--slurm", options->slurm,
                    "Run them as a job array of Slurm; the folder and the cache must be seen by all its machines");
  command->add_option("--merge", options->merge, "Also take the rows of these files (.csv), from other machines")
      ->delimiter(',');
  command
      ->add_option("--repeats", options->repeats,
                   "Uneven starts of each setting, the first with the reference's seed, each with the next (3; 2 with "
                   "--quick)")
      ->check(CLI::Range(1, 1000));
  command->callback([options, &status] { status = run(*options); });
}

} // namespace tutu::app
