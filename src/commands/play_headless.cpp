// Playing without a window: films, pictures, figures.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "src/base/json_text.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/commands/play_options.h"
#include "src/measure/run_stats.h"
#include "src/run/posed_body.h"
#include "src/scene/load.h"
#include "src/view/render/image_text.h"
#include "src/view/render/offscreen.h"
#include "src/view/render/png.h"
#include "src/view/render/video.h"
#include "src/view/show/scene_view.h"
#include "src/view/show/why.h"

#include <algorithm>
#include <fmt/format.h>
#include <numbers>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

/// Two pictures of one size as one, a white line between them.
Image side_by_side(const Image& left, const Image& right) {
  Image both{.width = left.width + right.width, .height = left.height, .pixels = {}};
  both.pixels.reserve(left.pixels.size() + right.pixels.size());
  for (int y = 0; y < left.height; ++y)
    for (const Image* side : {&left, &right})
      both.pixels.insert(both.pixels.end(), side->at(0, y), side->at(0, y) + std::ptrdiff_t{3} * side->width);
  blend_box(both, left.width - 1, 0, 2, both.height, {1.0f, 1.0f, 1.0f}, 1.0f);
  return both;
}

/// How far particles of two sessions are apart, frame by frame; nothing where they are not the same ones.
class Apart {
public:
  void add(const Session& a, const Session& b) {
    const std::size_t garments = a.scene().garments.size();
    for (std::size_t g = 0; g < std::min(garments, b.scene().garments.size()); ++g) {
      const std::vector<Vec3>& p = a.garment(static_cast<int>(g)).particles().positions;
      const std::vector<Vec3>& q = b.garment(static_cast<int>(g)).particles().positions;
      if (p.size() != q.size()) continue;
      for (std::size_t i = 0; i < p.size(); ++i) mm_.add(1000.0 * (p[i] - q[i]).norm());
    }
  }
  nlohmann::json json() const {
    if (mm_.count() == 0) return nullptr;
    const cloth::Spread apart = mm_.spread();
    return {{"max", apart.max}, {"p99", apart.p99}, {"mean", apart.mean}};
  }

private:
  cloth::SpreadGatherer mm_;
};

/// Where the pictures of a run go: a film, numbered PNGs, chosen PNGs, or nowhere.
class Pictures {
public:
  /// `other`: beside it, or null.
  Pictures(const PlayOptions& options, const LoadedScene& scene, const LoadedScene* other)
      : at_(options.at), stem_(scene.name()), layers_(layers_of(options)) {
    if (options.no_pictures) return;
    auto [width, height] = size_of(options.size);
    if (other) width /= 2;
    offscreen_.emplace(OffscreenOptions{width, height, options.supersample});
    const auto radians = [](double degrees) { return static_cast<float>(degrees * std::numbers::pi / 180.0); };
    camera_ = frame_camera(motion_points(scene), radians(options.yaw_degrees), radians(options.pitch_degrees),
                           offscreen_->aspect());
    view_.emplace(scene);
    view_->set_error_scale(ErrorScale::of(1e-3 * options.tolerance_mm));
    if (other) {
      width *= 2;
      caption_ = split_caption(options);
      other_view_.emplace(*other);
      other_view_->set_error_scale(ErrorScale::of(1e-3 * options.tolerance_mm));
    }

    const PictureTarget target = picture_target(options, scene);
    out_ = target.path;
    if (target.film) video_.emplace(out_, width, height, scene.settings.frames_per_second);
    if (!target.film && at_.empty() && options.out.empty())
      fmt::print(stderr, "note: no ffmpeg here, so the frames go to {}/\n", out_.string());
  }

  void add(const Session& session, const Session* other) {
    const bool wanted = offscreen_ && (at_.empty() || std::find(at_.begin(), at_.end(), session.frame()) != at_.end());
    if (!wanted) return;
    FrameView view = view_->frame(session, layers_);
    if (other) view.caption = stem_;
    offscreen_->draw(view, camera_, image_);
    if (other) {
      capture(session, captured_);
      FrameView beside = other_view_->frame(*other, layers_, &captured_);
      beside.caption = caption_;
      offscreen_->draw(beside, camera_, other_image_);
      image_ = side_by_side(image_, other_image_);
    }
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
  std::string stem_, caption_;
  Layers layers_;
  fs::path out_;
  Camera camera_;
  std::optional<Offscreen> offscreen_;
  std::optional<SceneView> view_, other_view_;
  FrameState captured_;
  std::optional<VideoWriter> video_;
  Image image_, other_image_;
  int count_ = 0;
};

/// Each recovery that was kept, with the constraint that was bad first.
void tell_recoveries(const RunTroubles& troubles) {
  for (const RunRecovery& recovery : troubles.first_recoveries) fmt::print(stderr, "note: {}\n", recovery.message());
  const int more = troubles.recoveries - static_cast<int>(troubles.first_recoveries.size());
  if (more > 0) fmt::print(stderr, "note: and {} recoveries more\n", more);
}

/// What --why asks, looked for while the run goes on.
class Explainer {
public:
  Explainer(const LoadedScene& scene, const std::string& text, int frames)
      : scene_(&scene), address_(why_address(scene, text, frames)) {}

  int frame() const { return address_.frame; }
  const std::optional<Why>& why() const { return why_; } ///< once that frame was seen

  /// After each frame, from 0 on.
  void look(const Session& session) {
    if (session.frame() > address_.frame) return;
    std::swap(before_, now_);
    capture(session, now_);
    if (!first_wrong_) first_wrong_ = wrong_in(*scene_, address_.garment, address_.particle, now_);
    if (session.frame() < address_.frame) return;
    why_ = explain(*scene_, address_.garment, address_.particle, now_, session.frame() > 0 ? &before_ : nullptr);
    why_->first_wrong = first_wrong_;
  }

private:
  const LoadedScene* scene_;
  WhyAddress address_;
  FrameState before_, now_;
  std::optional<FirstWrong> first_wrong_;
  std::optional<Why> why_;
};

} // namespace

PictureTarget picture_target(const PlayOptions& options, const Scene& scene) {
  if (options.no_pictures) return {};
  const bool chosen = !options.at.empty() || options.worst;
  const fs::path out = options.out;
  const bool film = !chosen && (out.empty() ? ffmpeg_available() : out.extension() == ".mp4");
  if (!out.empty()) return {out, film};
  return {film ? scene.name() + ".mp4" : chosen ? "." : scene.name() + "-frames", film};
}

int play_headless(const PlayOptions& options, const Draped& first, const Draped* other) {
  const LoadedScene& scene = first.scene;
  Session session(scene);
  session.stop_when(&interrupt_flag());
  session.start(first.start);
  std::optional<Session> beside;
  if (other) {
    beside.emplace(other->scene);
    beside->stop_when(&interrupt_flag());
    beside->start(other->start);
  }
  int frames = frames_to_play(options, scene);
  if (!options.frames && !options.at.empty()) frames = *std::max_element(options.at.begin(), options.at.end());
  std::optional<Explainer> explainer;
  if (!options.why.empty()) {
    explainer.emplace(scene, options.why, frames);
    if (!options.frames && options.at.empty()) frames = explainer->frame();
  }

  Pictures pictures(options, scene, other ? &other->scene : nullptr);
  RunStats stats(scene), other_stats(other ? other->scene : scene);
  Apart apart;
  const auto picture = [&] { pictures.add(session, beside ? &*beside : nullptr); };
  session.skin_body();
  if (beside) beside->skin_body();
  if (!options.at.empty()) picture(); // frame 0 is the draped start; a film begins with the first motion
  if (explainer) explainer->look(session);
  Progress bar(scene.name(), frames);
  while (session.frame() < frames && !interrupted()) {
    session.advance();
    if (session.failure() || session.stopped()) break;
    session.skin_body();
    stats.add(session);
    if (beside) {
      beside->advance();
      if (beside->failure() || beside->stopped()) break;
      beside->skin_body();
      other_stats.add(*beside);
      apart.add(session, *beside);
    }
    picture();
    if (explainer) explainer->look(session);
    bar.tick(session.frame());
  }
  bar.finish();

  const Session& failed = beside && beside->failure() ? *beside : session;
  const bool diverged = failed.failure().has_value();
  const std::string written = diverged ? "" : pictures.finish();
  fmt::print("{}", stats.text(session));
  const RunEnd end = stats.end(session);
  nlohmann::json json = stats.json(session, end);
  std::string warning = end.warning();
  if (beside) {
    const RunEnd other_end = other_stats.end(*beside);
    json["against"] = other_stats.json(*beside, other_end);
    json["against"]["setting"] = split_caption(options);
    json["apart_mm"] = apart.json();
    fmt::print("beside it, {}: {}", split_caption(options), other_stats.text(*beside));
    fmt::print("apart, mm: {}\n", json["apart_mm"].dump());
    if (const std::string wrong = other_end.warning(); !wrong.empty())
      warning += fmt::format("{}beside it, {}: {}", warning.empty() ? "" : "; ", split_caption(options), wrong);
  }
  if (explainer && explainer->why()) {
    json["why"] = json_of(*explainer->why());
    for (const std::string& line : text_of(*explainer->why())) fmt::print("{}\n", line);
  }
  if (!options.json.empty()) write_file(options.json, json_text(json));
  if (!written.empty()) fmt::print("wrote {}\n", written);
  tell_recoveries(session.troubles());
  if (diverged) fmt::print(stderr, "tutu: {}\n", failed.failure()->message());
  if (interrupted()) fmt::print(stderr, "tutu: interrupted after {} of {} frames\n", session.frame(), frames);
  print_warning(warning);
  return diverged || interrupted() ? k_not_met : k_ok;
}

} // namespace tutu::app
