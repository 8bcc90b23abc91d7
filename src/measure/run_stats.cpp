#include "src/measure/run_stats.h"

#include "rig/error.h"
#include "src/measure/uneven_json.h"

#include <algorithm>
#include <fmt/format.h>

namespace tutu::app {
namespace {

nlohmann::json json_of(const cloth::Spread& s) { return {{"max", s.max}, {"p99", s.p99}, {"mean", s.mean}}; }

/// In per cent.
nlohmann::json percent_of(const cloth::Spread& s) { return json_of({100.0 * s.max, 100.0 * s.p99, 100.0 * s.mean}); }

} // namespace

RunStats::RunStats(const Scene& scene) : scene_(&scene), history_(scene.garments.size()) {
  for (const cloth::Garment& garment : scene.garments) probes_.emplace_back(garment);
}

const proxies::BodyMesh& RunStats::posed_body(const Session& session) {
  if (!body_) body_.emplace(body_of(scene_->character));
  body_->pose(session.body_positions());
  return *body_;
}

void RunStats::add(const Session& session) {
  const FrameTimes& t = session.times();
  const double ms[] = {t.pose, t.proxies, t.broad, t.cloth, t.contact, t.skin, t.total()};
  for (std::size_t k = 0; k < stages_.size(); ++k) stages_[k].ms.add(ms[k]);
  if (session.collides_with_body()) posed_body(session);
  double surface = 0.0;
  for (std::size_t g = 0; g < probes_.size(); ++g) {
    const std::vector<Vec3>& positions = session.garment(static_cast<int>(g)).particles().positions;
    depths_.clear();
    if (session.collides_with_body()) probes_[g].measure(*body_, positions, depths_);
    else probes_[g].measure(session.colliders_of(static_cast<int>(g)), positions, depths_);
    for (const double depth : depths_.particle_depths) particles_mm_.add(1000.0 * depth);
    inside_ += depths_.particles.inside;
    surface = std::max(surface, depths_.surface);
    strains_.add(probes_[g].parts(), positions);
    History& history = history_[g];
    if (frames_ >= 2)
      jitters_.add(
          cloth::jitter_of(probes_[g].parts(), history.before_last, history.last, positions, session.frame_seconds()));
    history.before_last.swap(history.last);
    history.last = positions;
  }
  surface_mm_.add(1000.0 * surface);
  ++frames_;
}

RunEnd RunStats::end(const Session& session) {
  const proxies::BodyMesh* body = nullptr;
  try {
    body = &posed_body(session);
  } catch (const InputError&) { // a mesh without sides has no inside
  }
  return end_of(session, probes_, body);
}

nlohmann::json RunStats::json(const Session& session, const RunEnd& end) const {
  nlohmann::json ms;
  for (const Stage& stage : stages_)
    ms[stage.name] = {{"median", stage.ms.percentile(0.5)}, {"p99", stage.ms.percentile(0.99)}};
  const char* what = session.collides_with_body() ? "body" : "proxies";
  const cloth::ThreadStrains strains = strains_.strains();
  nlohmann::json result = {{"scene", scene_->name()},
                           {"frames", frames_},
                           {"solver", name_of(scene_->settings.solver)},
                           {"substeps", substeps_json(session)},
                           {"backend", session.backend()},
                           {"threads", session.threads()},
                           {"ms_per_frame", ms},
                           {"penetration_mm", {{what, json_of(particles_mm_.spread())}}},
                           {"surface_mm", {{what, json_of(surface_mm_.spread())}}},
                           {"share_inside", static_cast<double>(inside_) /
                                                static_cast<double>(std::max<std::int64_t>(1, particles_mm_.count()))},
                           {"longer_pct", percent_of(strains.longer)},
                           {"shorter_pct", percent_of(strains.shorter)},
                           {"held_longer_pct", percent_of(strains.held_longer)},
                           {"jitter", jitters_.spread().mean},
                           {"diverged", session.failure().has_value()},
                           {"recoveries", session.troubles().recoveries},
                           {"teleports", session.troubles().teleports},
                           {"end", end.json()},
                           {"state_hash", fmt::format("{:016x}", session.state_hash())}};
  result.update(uneven_json(scene_->settings));
  for (const RunRecovery& recovery : session.troubles().first_recoveries)
    result["first_recoveries"].push_back(recovery.message());
  if (session.failure()) result["failure"] = session.failure()->message();
  return result;
}

nlohmann::json RunStats::substeps_json(const Session& session) const {
  const int asked = scene_->settings.substeps;
  const RunTroubles& troubles = session.troubles();
  nlohmann::json result = {{"asked", asked},
                           {"max", std::max(asked, troubles.worst_split.substeps)},
                           {"frames_split", troubles.frames_split}};
  if (troubles.frames_split > 0) result["reason"] = session.worst_split_reason();
  return result;
}

std::string RunStats::text(const Session& session) const {
  int count = 0;
  for (const cloth::Garment& garment : scene_->garments) count += garment.particle_count();
  std::string text = fmt::format(
      "{}: {} frames ({:.2f} s), {} garments of {} particles, {} proxies ({}), {}, {} substeps a frame\n",
      scene_->name(), frames_, frames_ * session.frame_seconds(), scene_->garments.size(), count,
      session.colliders().size(), session.backend(), name_of(scene_->settings.solver), scene_->settings.substeps);
  if (frames_ == 0) return text;
  text += "ms a frame, median (p99):";
  for (const Stage& stage : stages_)
    text += fmt::format("  {} {:.3f} ({:.3f})", stage.name, stage.ms.percentile(0.5), stage.ms.percentile(0.99));
  const cloth::Spread particles = particles_mm_.spread(), surface = surface_mm_.spread();
  const cloth::ThreadStrains strains = strains_.strains();
  text +=
      fmt::format("\ninto {}: particles {:.2f} mm at most, {:.3f} mean; surface {:.2f} mm at most, {:.2f} p99 of the "
                  "frames\nthreads longer by {:.1f} % at most, {:.1f} p99, {:.1f} mean; shorter by {:.1f} at most, "
                  "{:.1f} p99, {:.1f} mean",
                  session.collides_with_body() ? "the body" : "proxies", particles.max, particles.mean, surface.max,
                  surface.p99, 100 * strains.longer.max, 100 * strains.longer.p99, 100 * strains.longer.mean,
                  100 * strains.shorter.max, 100 * strains.shorter.p99, 100 * strains.shorter.mean);
  if (strains.held_longer.max > 5e-4) // shown as more than 0.0
    text += fmt::format("; held ones longer by {:.1f} at most", 100 * strains.held_longer.max);
  text += fmt::format("\njitter: {:.2f} m/s2\n", jitters_.spread().mean);
  if (scene_->settings.uneven_mm > 0.0)
    text += fmt::format("start uneven by {:g} mm, seed {}\n", scene_->settings.uneven_mm, scene_->settings.seed);
  text += fmt::format("state hash {:016x}\n", session.state_hash());
  const RunTroubles& troubles = session.troubles();
  if (troubles.frames_split > 0)
    text += fmt::format("{} frames in more substeps than asked, at most {} in frame {} ({})\n", troubles.frames_split,
                        troubles.worst_split.substeps, troubles.worst_split_frame, session.worst_split_reason());
  if (troubles.teleports > 0) text += fmt::format("{} jumps of the body, garments carried along\n", troubles.teleports);
  if (troubles.recoveries > 0) text += fmt::format("{} recoveries\n", troubles.recoveries);
  return text;
}

} // namespace tutu::app
