#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "src/base/json_text.h"
#include "src/base/outputs.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/options/scene_options.h"
#include "src/scene/load.h"
#include "src/study/report/gnuplot_chart.h"
#include "src/study/stability/map_files.h"
#include "src/study/stability/margin.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  SceneOptions scene;
  std::string out = "stability", json;
  std::vector<std::string> only;
  bool quick = false, no_pictures = false;
  std::optional<int> starts;
};

/// Keeps the maps that are asked for, by name or by how it begins.
void keep_only(const std::vector<std::string>& only, std::vector<StabilityMap>& maps) {
  if (only.empty()) return;
  for (const std::string& wanted : only)
    if (std::none_of(maps.begin(), maps.end(), [&](const StabilityMap& m) { return m.name.starts_with(wanted); })) {
      std::vector<std::string> names;
      for (const StabilityMap& map : maps) names.push_back(map.name);
      throw InputError("", "--only", wanted, fmt::format("one of {}", fmt::join(names, ", ")));
    }
  std::erase_if(maps, [&](const StabilityMap& map) {
    return std::none_of(only.begin(), only.end(), [&](const std::string& name) { return map.name.starts_with(name); });
  });
}

void write_pictures(const std::vector<StabilityMap>& maps, const SceneSetting& setting, const fs::path& folder) {
  for (const StabilityMap& map : maps)
    for (const char* extension : {".svg", ".png"}) {
      if (interrupted()) return;
      write_cell_chart(chart_of(map, setting), folder / (map.name + extension));
    }
}

int run(const Options& options) {
  const fs::path folder = options.out;
  if (!options.no_pictures) require_chart(folder / "map.svg"); // no gnuplot is told before long work
  catch_interrupt();
  const LoadedScene scene = options.scene.load();
  if (scene.garments.empty()) throw InputError(scene.file, "/garments", "none", "a garment to run");
  const SceneSetting setting = scene_setting(scene);
  if (std::isinf(stiffest(setting)->step_limit))
    throw InputError(scene.file, "/garments", "every particle held", "a garment that moves");
  check_outputs({{"--json", options.json}, {"--out", folder, true}}, inputs_of(scene.files));
  const FolderLock lock(folder, "tutu stability");
  const auto start = draped_start(scene);
  if (!start) return k_not_met;

  MapOptions what;
  what.quick = options.quick;
  what.starts = options.starts.value_or(options.quick ? 2 : 4);
  what.threads = options.scene.threads().value_or(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  if (setting.proxies.empty())
    fmt::print(stderr, "note: no proxy comes near the garments: no maps of speed, cells and overlap\n");
  std::vector<StabilityMap> maps = plan_maps(scene, setting, start_overlap(scene, *start), what);
  keep_only(options.only, maps);

  std::optional<Progress> bar; // the total is known with the first start
  const bool whole = run_maps(maps, what, [&](int done, int total) {
    if (!bar) bar.emplace("stability of " + scene.name(), total);
    bar->tick(done);
    return !interrupted();
  });
  bar.reset();
  if (!whole) {
    fmt::print(stderr, "tutu: interrupted; nothing written\n");
    return k_not_met;
  }
  write_file(folder / "cells.csv", maps_csv(maps));
  if (!options.json.empty()) write_file(options.json, json_text(maps_json(maps, scene, setting, what)));
  if (!options.no_pictures) write_pictures(maps, setting, folder);
  fmt::print("{}wrote {}\n", maps_text(maps, scene, setting), folder.string());
  const bool safe = std::all_of(maps.begin(), maps.end(), [&](const StabilityMap& map) {
    const auto margin = margin_of(map, setting.step);
    return !map.own_method || !margin || margin->holds;
  });
  return safe && !interrupted() ? k_ok : k_not_met;
}

} // namespace

void add_stability(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "stability", "Map where each method fails around a scene's own setting; exit with 1 when it fails there itself");
  auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command->get_option("--threads")->description("Threads that run cells side by side; all when left out");
  command->add_option("-o,--out", options->out, "Folder for the maps (.svg, .png) and cells.csv")
      ->capture_default_str();
  command->add_flag("--quick", options->quick, "Fewer cells and starts: about a minute on two cores");
  command->add_option("--starts", options->starts, "Uneven starts of each cell; 4, or 2 with --quick")
      ->check(CLI::Range(1, 1000));
  command->add_option("--only", options->only, "Maps whose names begin so")->delimiter(',');
  command->add_flag("--no-pictures", options->no_pictures, "Figures only: needs no gnuplot");
  command->add_option("--json", options->json, "Write all maps to this file");
  command->callback([options, &status] { status = run(*options); });
}

} // namespace tutu::app
