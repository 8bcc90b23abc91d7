#include "rig/error.h"
#include "rig/file_io.h"
#include "src/commands/commands.h"
#include "src/commands/scene_options.h"
#include "src/export/png.h"
#include "src/export/video.h"
#include "src/interrupt.h"
#include "src/progress.h"
#include "src/render/offscreen.h"
#include "src/scene/posed_body.h"
#include "src/scene/run_stats.h"
#include "src/scene/scene_player.h"
#include "src/stability/warning.h"
#include "src/viewer/viewer.h"
#include "src/viewer/window.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  SceneOptions scene;
  bool headless = false, no_pictures = false, fixed_substeps = false;
  std::optional<int> frames;
  std::string out, json;
  std::vector<int> at;
  std::vector<std::string> show, hide;
  std::vector<std::string> overlay;
  double tolerance_mm = 1000.0 * ErrorScale().tolerance;
  bool worst = false;
  std::string size = "1280x720";
  int supersample = 1;
  double yaw_degrees = 25.0, pitch_degrees = 8.0;
};

/// Refuses what cannot be carried out together, before anything long begins.
void check(const Options& options) {
  const fs::path out = options.out;
  const std::string suffix = out.extension().string();
  const std::vector<std::string> pictures = {".png", ".jpg", ".jpeg", ".gif", ".avi", ".mov", ".mkv", ".webm"};
  if ((!options.at.empty() || options.worst) && suffix == ".mp4")
    throw InputError("", "--out", options.out, "a folder for the pictures");
  if (std::find(pictures.begin(), pictures.end(), suffix) != pictures.end())
    throw InputError("", "--out", options.out, "a film (.mp4) or a folder");
  if (options.worst && options.frames) throw InputError("", "--worst", "it with --frames", "one of the two");
  if (!options.at.empty() && options.no_pictures)
    throw InputError("", "--at", "it with --no-pictures", "one of the two");
  for (const int frame : options.at)
    if (options.frames && frame > *options.frames)
      throw InputError("", "--at", std::to_string(frame), "at most --frames, " + std::to_string(*options.frames));
  if (!options.json.empty()) (void)PendingFile(options.json); // a place that cannot be written is told now
}

/// "1280x720" -> {1280, 720}.
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

std::vector<std::string> layer_names() {
  std::vector<std::string> names;
  for (const LayerInfo& layer : k_layers) names.push_back(layer.name);
  return names;
}

Layers layers_of(const Options& options) {
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

/// Where the pictures of a run go: a film, numbered PNGs, chosen PNGs, or nowhere.
class Pictures {
public:
  Pictures(const Options& options, const Scene& scene)
      : at_(options.at), stem_(scene.name()), layers_(layers_of(options)) {
    if (options.no_pictures) return;
    const auto [width, height] = size_of(options.size);
    offscreen_.emplace(OffscreenOptions{width, height, options.supersample});
    const auto radians = [](double degrees) { return static_cast<float>(degrees * std::numbers::pi / 180.0); };
    camera_ = frame_camera(motion_points(scene), radians(options.yaw_degrees), radians(options.pitch_degrees),
                           offscreen_->aspect());
    view_.emplace(scene);
    view_->set_error_scale(ErrorScale::of(1e-3 * options.tolerance_mm));

    out_ = options.out;
    const bool film = at_.empty() && (out_.empty() ? ffmpeg_available() : out_.extension() == ".mp4");
    if (out_.empty()) out_ = film ? stem_ + ".mp4" : at_.empty() ? stem_ + "-frames" : ".";
    if (film) video_.emplace(out_, width, height, scene.description.frames_per_second);
    else fs::create_directories(out_);
    if (!film && at_.empty() && options.out.empty())
      fmt::print(stderr, "note: no ffmpeg here, so the frames go to {}/\n", out_.string());
  }

  void add(Session& session) {
    const bool wanted = offscreen_ && (at_.empty() || std::find(at_.begin(), at_.end(), session.frame()) != at_.end());
    if (!wanted) return;
    offscreen_->draw(view_->frame(session, layers_), camera_, image_);
    if (video_) video_->add(image_);
    else write_png(out_ / fmt::format("{}-{:04}.png", stem_, session.frame()), image_);
    ++count_;
  }

  /// What was written, in words; "" for nothing.
  std::string finish() {
    if (count_ == 0) return "";
    if (video_) video_->finish();
    return video_ ? out_.string() : fmt::format("{} picture{} in {}/", count_, count_ == 1 ? "" : "s", out_.string());
  }

private:
  std::vector<int> at_;
  std::string stem_;
  Layers layers_;
  fs::path out_;
  Camera camera_;
  std::optional<Offscreen> offscreen_;
  std::optional<SceneView> view_;
  std::optional<VideoWriter> video_;
  Image image_;
  int count_ = 0;
};

/// Each recovery that was kept, with the constraint that was bad first.
void tell_recoveries(const SessionTroubles& troubles) {
  for (const SessionRecovery& recovery : troubles.first_recoveries)
    fmt::print(stderr, "note: {}\n", recovery.message());
  const int more = troubles.recoveries - static_cast<int>(troubles.first_recoveries.size());
  if (more > 0) fmt::print(stderr, "note: and {} recoveries more\n", more);
}

int play_headless(const Options& options, const Scene& scene, const std::vector<std::vector<Vec3>>& start) {
  Session session(scene);
  session.start(start);
  int frames = 0;
  if (options.frames) frames = *options.frames;
  else if (options.at.empty()) frames = frames_of(scene);
  else frames = *std::max_element(options.at.begin(), options.at.end());

  Pictures pictures(options, scene);
  RunStats stats(scene);
  session.skin_body();
  if (!options.at.empty()) pictures.add(session); // frame 0 is the draped start; a film begins with the first motion
  Progress bar(scene.name(), frames);
  while (session.frame() < frames && !interrupted()) {
    session.advance();
    if (session.failure()) break;
    session.skin_body();
    stats.add(session);
    pictures.add(session);
    bar.tick(session.frame());
  }
  bar.finish();

  const bool diverged = session.failure().has_value();
  const std::string written = diverged ? "" : pictures.finish();
  fmt::print("{}", stats.text(session));
  if (!options.json.empty()) write_file(options.json, stats.json(session).dump(2) + "\n");
  if (!written.empty()) fmt::print("wrote {}\n", written);
  tell_recoveries(session.troubles());
  if (diverged) fmt::print(stderr, "tutu: {}\n", session.failure()->message());
  if (interrupted()) fmt::print(stderr, "tutu: interrupted after {} of {} frames\n", session.frame(), frames);
  return diverged || interrupted() ? k_not_met : k_ok;
}

/// The frame that --worst asks for, told; none when interrupted.
std::optional<int> find_worst(const Scene& scene) {
  Progress bar("looking for the worst frame", frames_of(scene));
  const std::optional<int> frame = worst_frame(scene, [&](int done, int) {
    bar.tick(done);
    return !interrupted();
  });
  bar.finish();
  if (frame) fmt::print("the skin sticks out of the proxies the most in frame {}\n", *frame);
  return frame;
}

int run(const Options& options) {
  const bool headless = options.headless || !options.json.empty() || !options.at.empty() || !display_available();
  check(options);
  if (headless) catch_interrupt();
  Scene scene = options.scene.load();
  if (options.fixed_substeps) scene.description.adaptive_substeps = false;
  if ((layers_of(options).proxy_error || options.worst) && scene.proxies.empty())
    throw InputError(scene.description.file.string(), "/proxies", "none", "proxies to show the error of");
  if (const std::string warning = warning_of(scene); !warning.empty())
    fmt::print(stderr, "warning: outside of what is safe (see tutu stability): {}\n", warning);
  const auto start = draped_start(scene);
  if (!start) return k_not_met;
  if (headless && options.worst) {
    const std::optional<int> frame = find_worst(scene);
    if (!frame) return k_not_met;
    Options at_worst = options;
    at_worst.at.push_back(*frame);
    return play_headless(at_worst, scene, *start);
  }
  if (headless) return play_headless(options, scene, *start);
  ScenePlayer player(scene, *start);
  player.set_error_scale(ErrorScale::of(1e-3 * options.tolerance_mm));
  ViewerOptions viewer;
  viewer.layers = layers_of(options);
  viewer.start_at_worst = options.worst;
  return run_viewer(player, viewer);
}

} // namespace

void add_play(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("play", "Play a scene in a window, or render it without one");
  auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command->add_flag("--headless", options->headless,
                    "No window: render to a film (.mp4), or PNGs where there is no ffmpeg");
  command->add_option("--frames", options->frames, "Frames to play; once through the motion when left out")
      ->check(CLI::Range(1, k_most_frames));
  command->add_option("-o,--out", options->out, "Film (.mp4) or folder for PNGs");
  command->add_option("--json", options->json, "Write the figures of the run to this file (implies --headless)");
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
  command->add_option("--size", options->size, "Pixels of the pictures")->capture_default_str();
  command->add_option("--supersample", options->supersample, "Draw this many times finer and average")
      ->check(CLI::Range(1, 4))
      ->capture_default_str();
  command->add_option("--yaw", options->yaw_degrees, "Camera: degrees around the dancer, 0 from the front")
      ->check(finite_number())
      ->capture_default_str();
  command->add_option("--pitch", options->pitch_degrees, "Camera: degrees from above")
      ->check(finite_number())
      ->capture_default_str();
  command->add_flag("--fixed-substeps", options->fixed_substeps,
                    "Never more substeps than asked, however fast something moves");
  command->add_flag("--no-pictures", options->no_pictures, "Simulate only (with --headless or --json)");
  command->callback([options, &status] { status = run(*options); });
}

} // namespace tutu::app
