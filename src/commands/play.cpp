#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "src/base/outputs.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/commands/play_options.h"
#include "src/measure/worst_frame.h"
#include "src/run/posed_body.h"
#include "src/scene/load.h"
#include "src/scene/scene_override.h"
#include "src/study/stability/warning.h"
#include "src/view/window/window.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

/// Refuses what cannot be carried out together, before anything long begins.
void check(const PlayOptions& options) {
  const fs::path out = options.out;
  const std::string suffix = out.extension().string();
  const std::vector<std::string> pictures = {".png", ".jpg", ".jpeg", ".gif", ".avi", ".mov", ".mkv", ".webm"};
  if ((!options.at.empty() || options.worst) && suffix == ".mp4")
    throw InputError("", "--out", options.out, "a folder for the pictures");
  if (std::find(pictures.begin(), pictures.end(), suffix) != pictures.end())
    throw InputError("", "--out", options.out, "a film (.mp4) or a folder");
  if (options.window && options.headless) throw InputError("", "--window", "it with --headless", "one of the two");
  if (options.window && (!options.at.empty() || options.no_pictures))
    throw InputError("", "--window", "it with --at or --no-pictures", "one of the two");
  if (!options.against.empty() && !options.split.empty())
    throw InputError("", "--against", "it with --split", "one of the two");
  if (options.worst && options.frames) throw InputError("", "--worst", "it with --frames", "one of the two");
  if (!options.at.empty() && options.no_pictures)
    throw InputError("", "--at", "it with --no-pictures", "one of the two");
  for (const int frame : options.at)
    if (options.frames && frame > *options.frames)
      throw InputError("", "--at", std::to_string(frame), "at most --frames, " + std::to_string(*options.frames));
}

std::vector<std::string> layer_names() {
  std::vector<std::string> names;
  for (const LayerInfo& layer : k_layers) names.push_back(layer.name);
  return names;
}

/// The frame that --worst asks for, told; none when interrupted.
std::optional<int> find_worst(const LoadedScene& scene) {
  Progress bar("looking for the worst frame", frames_of(scene));
  const std::optional<int> frame = worst_frame(scene, [&](int done, int) {
    bar.tick(done);
    return !interrupted();
  });
  bar.finish();
  if (frame) fmt::print("the skin sticks out of the proxies the most in frame {}\n", *frame);
  return frame;
}

int run(const PlayOptions& options) {
  const bool wants_files = !options.json.empty() || !options.at.empty() || !options.why.empty();
  const bool headless = !options.window && (options.headless || wants_files || !display_available());
  check(options);
  if (headless) catch_interrupt();
  Draped first{load(options), {}};
  std::vector<fs::path> inputs = inputs_of(first.scene.files);
  if (!options.against.empty()) inputs.emplace_back(options.against);
  const PictureTarget target = headless ? picture_target(options, first.scene) : PictureTarget{};
  check_outputs({{"--json", options.json}, {"--out", target.path, !target.film}}, inputs);
  auto start = draped_start(first.scene);
  if (!start) return k_not_met;
  first.start = std::move(*start);
  std::optional<Draped> other;
  if (is_split(options)) {
    other = other_scene(options, first);
    if (!other) return k_not_met;
  }
  if (!headless) return play_in_window(options, std::move(first), std::move(other));
  if (!options.worst) return play_headless(options, first, other ? &*other : nullptr);
  const std::optional<int> frame = find_worst(first.scene);
  if (!frame) return k_not_met;
  PlayOptions at_worst = options;
  at_worst.at.push_back(*frame);
  return play_headless(at_worst, first, other ? &*other : nullptr);
}

} // namespace

Layers layers_of(const PlayOptions& options) {
  Layers layers;
  const auto set = [&](const std::vector<std::string>& names, bool on) {
    for (const LayerInfo& layer : k_layers)
      if (std::find(names.begin(), names.end(), layer.name) != names.end()) layers.*layer.member = on;
  };
  set(options.show, true);
  set(options.overlay, true);
  set(options.hide, false);
  return layers;
}

LoadedScene load(const PlayOptions& options) {
  LoadedScene scene = options.scene.load();
  if ((layers_of(options).proxy_error || options.worst) && scene.proxies.empty())
    throw InputError(scene.file, "/proxies", "none", "proxies to show the error of");
  if (const std::string warning = warning_of(scene); !warning.empty())
    fmt::print(stderr, "warning: outside of what is safe (see tutu stability): {}\n", warning);
  return scene;
}

std::pair<int, int> size_of(const std::string& text) {
  const auto side = [](std::string_view digits) {
    int value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size() && value >= 16 && value <= 8192 ? value : 0;
  };
  const std::size_t cross = text.find('x');
  const std::string_view all = text;
  const int width = cross == std::string::npos ? 0 : side(all.substr(0, cross));
  const int height = cross == std::string::npos ? 0 : side(all.substr(cross + 1));
  if (width == 0 || height == 0) throw InputError("", "--size", text, "WIDTHxHEIGHT, each from 16 to 8192");
  return {width, height};
}

bool is_split(const PlayOptions& options) { return !options.against.empty() || !options.split.empty(); }

std::string split_caption(const PlayOptions& options) {
  return options.against.empty() ? options.split : std::filesystem::path(options.against).stem().string();
}

std::optional<Draped> other_scene(const PlayOptions& options, const Draped& first) {
  PlayOptions other = options;
  Draped draped;
  if (!options.against.empty()) {
    other.scene.scene = options.against;
    draped.scene = load(other);
  } else {
    SceneDescription description = first.scene.description();
    override_setting(description, options.split, "--split");
    draped.scene = load_scene(description);
  }
  const double frames = first.scene.settings.frames_per_second, others = draped.scene.settings.frames_per_second;
  if (frames != others)
    throw InputError(draped.scene.file, "/solver/frames_per_second", fmt::format("{}", others),
                     fmt::format("{}, as the first scene has", frames));
  if (!options.split.empty()) { // the same start, so that what differs is the setting's doing
    draped.start = first.start;
    return draped;
  }
  auto start = draped_start(draped.scene);
  if (!start) return std::nullopt;
  draped.start = std::move(*start);
  return draped;
}

int frames_to_play(const PlayOptions& options, const LoadedScene& scene) {
  return options.frames ? *options.frames : frames_of(scene);
}

void add_play(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("play", "Play a scene in a window, or render it without one");
  auto options = std::make_shared<PlayOptions>();
  options->scene.add_to(*command);
  command->add_flag("--headless", options->headless,
                    "No window: render to a film (.mp4), or PNGs where there is no ffmpeg");
  command->add_flag("--window", options->window,
                    "The window, whatever else is asked for; with --frames it closes after them, and --json tells what "
                    "it showed at its end");
  command->add_flag("--paused", options->paused, "The window opens without playing");
  command->add_option("--frames", options->frames, "Frames to play; once through the motion when left out")
      ->check(CLI::Range(1, k_most_frames));
  command->add_option("-o,--out", options->out, "Film (.mp4) or folder for PNGs");
  command->add_option("--json", options->json, "Write the figures of the run to this file (implies --headless)");
  command->add_option("--why", options->why,
                      "GARMENT:PARTICLE@FRAME: what that particle touches, what pulls on it, and when it first went "
                      "wrong (implies --headless)");
  command->add_option("--against", options->against, "A second scene beside the first, in step");
  command->add_option("--split", options->split,
                      "KEY=VALUE: the same scene beside itself with that setting (substeps=4, solver=mass_spring, "
                      "proxies=FILE), in step, the cloth coloured by how far it is apart");
  command->add_option("--at", options->at, "Only pictures of these frames, as PNG (implies --headless)")
      ->delimiter(',')
      ->check(CLI::Range(0, k_most_frames));
  command->add_option("--show", options->show, "Layers to show besides the usual")
      ->delimiter(',')
      ->check(CLI::IsMember(layer_names()));
  command->add_option("--hide", options->hide, "Layers not to show")
      ->delimiter(',')
      ->check(CLI::IsMember(layer_names()));
  command
      ->add_option("--overlay", options->overlay,
                   "proxy-error: the skin in the colours of its distance from the proxies; penetration: the cloth in "
                   "those of its depth in the true body")
      ->check(CLI::IsMember({"proxy-error", "penetration"}));
  command->add_option("--tolerance-mm", options->tolerance_mm, "Of the overlay: what is nearer than this stays white")
      ->check(finite_number())
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command->add_flag(
      "--worst", options->worst,
      "Go to the frame in which the skin sticks out of the proxies the most (headless: only its picture)");
  command->add_option("--size", options->size, "Pixels of the pictures, and of the window")->capture_default_str();
  command->add_option("--supersample", options->supersample, "Draw this many times finer and average")
      ->check(CLI::Range(1, 4))
      ->capture_default_str();
  command->add_option("--yaw", options->yaw_degrees, "Camera: degrees around the dancer, 0 from the front")
      ->check(finite_number())
      ->capture_default_str();
  command->add_option("--pitch", options->pitch_degrees, "Camera: degrees from above")
      ->check(finite_number())
      ->capture_default_str();
  command->add_flag("--no-pictures", options->no_pictures, "Simulate only (with --headless or --json)");
  command->callback([options, &status] { status = run(*options); });
}

} // namespace tutu::app
