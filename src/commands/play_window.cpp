// Playing in a window, and what it showed when it closed.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/json_text.h"
#include "src/commands/commands.h"
#include "src/commands/play_options.h"
#include "src/scene/load.h"
#include "src/view/play/split_player.h"
#include "src/view/play/viewer.h"
#include "src/view/proxy_edit/proxy_edit_mode.h"
#include "src/view/window/recent_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tuple>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

nlohmann::json json_of(ScenePlayer& player, const ViewerEnd& end) {
  const Figures figures = player.figures().front();
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
                         {"pictures", end.pictures},
                         {"drawing_ms", end.drawing_ms},
                         {"recorded", {{"first", player.extent().first}, {"last", player.extent().last}}},
                         {"layers", nlohmann::json::array()},
                         {"why", nullptr}};
  for (const LayerInfo& layer : k_layers)
    if (end.layers.*layer.member) json["layers"].push_back(layer.name);
  if (const auto why = player.why_shown()) json["why"] = json_of(*why);
  if (const auto why = player.why_edge()) json["why_edge"] = json_of(*why);
  if (const auto why = player.why_proxy()) json["why_proxy"] = json_of(*why);
  return json;
}

/// A scene file, or a character in its own motion without garments. Throws InputError.
Draped open(const PlayOptions& options, const fs::path& file) {
  Draped opened;
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

void set_up(ScenePlayer& player, const PlayOptions& options, const std::string& why, int frames) {
  player.set_error_scale(ErrorScale::of(1e-3 * options.tolerance_mm));
  if (why.empty()) return;
  const WhyAddress address = why_address(player.scene(), why, frames);
  player.pick(address.garment, address.particle);
  player.go(address.frame);
}

} // namespace

int play_in_window(const PlayOptions& options, Draped first, std::optional<Draped> other) {
  std::string message, why = options.why;
  ViewerOptions viewer = viewer_options(options);
  for (;;) {
    remember_file(first.scene.files.file);
    viewer.recent = recent_files();
    viewer.browse = first.scene.files.file.parent_path();
    viewer.message = message;
    const int frames = frames_to_play(options, first.scene);
    ViewerEnd end;
    std::string stopped;
    nlohmann::json json;
    if (other) {
      SplitPlayer player({&first.scene, first.start, first.scene.name()},
                         {&other->scene, other->start, split_caption(options)}, frames);
      for (ScenePlayer* side : {&player.left(), &player.right()}) set_up(*side, options, why, frames);
      end = run_viewer(player, viewer);
      stopped = player.message();
      json = json_of(player.left(), end);
      json["against"] = json_of(player.right(), end);
      json["against"]["setting"] = split_caption(options);
    } else {
      ScenePlayer player(first.scene, first.start, frames);
      set_up(player, options, why, frames);
      ProxyEditMode edit(first.scene, player, first.start, draped_start);
      edit.set_error_scale(ErrorScale::of(1e-3 * options.tolerance_mm));
      viewer.mode = &edit;
      end = run_viewer(player, viewer);
      viewer.mode = nullptr;
      first.start = edit.start();
      stopped = player.message();
      json = json_of(player, end);
      json["proxy_edit"] = edit.editor().json();
    }
    if (!options.json.empty()) write_file(options.json, json_text(json));
    if (!stopped.empty()) fmt::print(stderr, "tutu: {}\n", stopped);
    if (!end.open) return stopped.empty() ? k_ok : k_not_met;
    viewer.layers = end.layers;
    why.clear();
    message.clear();
    try {
      first = open(options, *end.open);
      other.reset();
    } catch (const std::exception& error) { // the last scene goes on, and says why
      message = error.what();
    }
  }
}

} // namespace tutu::app
