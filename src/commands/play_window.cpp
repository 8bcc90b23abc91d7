// Playing in a window, and what it showed when it closed.
#include "rig/error.h"
#include "rig/file_io.h"
#include "src/commands/commands.h"
#include "src/commands/play_options.h"
#include "src/scene/scene_player.h"
#include "src/viewer/recent_files.h"
#include "src/viewer/viewer.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tuple>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

nlohmann::json json_of(ScenePlayer& player, const ViewerEnd& end) {
  const Figures figures = *player.figures();
  nlohmann::json json = {{"scene", player.title()},
                         {"frame", figures.frame},
                         {"state_hash", fmt::format("{:016x}", figures.state_hash)},
                         {"particles", figures.particles},
                         {"contacts", figures.contacts},
                         {"substeps", figures.substeps},
                         {"recoveries", figures.recoveries},
                         {"deepest_mm", 1000.0 * figures.deepest},
                         {"playing", end.playing},
                         {"time_scale", end.time_scale},
                         {"recorded", {{"first", player.extent().first}, {"last", player.extent().last}}},
                         {"layers", nlohmann::json::array()},
                         {"why", nullptr}};
  for (const LayerInfo& layer : k_layers)
    if (end.layers.*layer.member) json["layers"].push_back(layer.name);
  if (const auto why = player.why_shown()) json["why"] = json_of(*why);
  return json;
}

struct Opened {
  Scene scene;
  std::vector<std::vector<Vec3>> start;
};

/// A scene file, or a character in its own motion without garments. Throws InputError.
Opened open(const PlayOptions& options, const fs::path& file) {
  Opened opened;
  if (file.extension() == ".json") {
    PlayOptions other = options;
    other.scene.scene = file.string();
    opened.scene = load(other);
    const auto start = draped_start(opened.scene);
    if (!start) throw InputError(file.string(), "", "garments that do not settle", "a scene that can be draped");
    opened.start = *start;
    return opened;
  }
  SceneDescription description;
  description.file = description.character = file;
  description.motion = OwnMotion{0};
  opened.scene = load_scene(description);
  return opened;
}

ViewerOptions viewer_options(const PlayOptions& options) {
  ViewerOptions viewer;
  std::tie(viewer.width, viewer.height) = size_of(options.size);
  viewer.layers = layers_of(options);
  viewer.playing = !options.paused && options.why.empty();
  viewer.start_at_worst = options.worst;
  viewer.close_at_end = options.frames.has_value();
  viewer.loop = !options.frames;
  if (!options.out.empty()) viewer.pictures = options.out;
  return viewer;
}

} // namespace

int play_in_window(const PlayOptions& options, Scene scene, std::vector<std::vector<Vec3>> start) {
  std::string message, why = options.why;
  ViewerOptions viewer = viewer_options(options);
  for (;;) {
    if (!scene.description.file.empty()) remember_file(scene.description.file);
    std::optional<std::string> next;
    {
      ScenePlayer player(scene, start, frames_to_play(options, scene));
      player.set_error_scale(ErrorScale::of(1e-3 * options.tolerance_mm));
      if (!why.empty()) {
        const WhyAddress address = why_address(scene, why, frames_to_play(options, scene));
        player.pick(address.garment, address.particle);
        player.go(address.frame);
      }
      viewer.recent = recent_files();
      viewer.message = message;
      const ViewerEnd end = run_viewer(player, viewer);
      if (!options.json.empty()) write_file(options.json, json_of(player, end).dump(2) + "\n");
      viewer.layers = end.layers;
      next = end.open;
    }
    if (!next) return k_ok;
    why.clear();
    message.clear();
    try {
      Opened opened = open(options, *next);
      scene = std::move(opened.scene);
      start = std::move(opened.start);
    } catch (const std::exception& error) { // the last scene goes on, and says why
      message = error.what();
    }
  }
}

} // namespace tutu::app
