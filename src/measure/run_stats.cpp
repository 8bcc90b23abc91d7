#include "src/measure/run_stats.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

nlohmann::json json_of(const cloth::Spread& s) { return {{"max", s.max}, {"p99", s.p99}, {"mean", s.mean}}; }

/// As cloth::penetration_of, of what the garment collided with.
std::vector<double> depths_in_body(const Session& session, int g) {
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(session.scene().garments[g]);
  const std::vector<Vec3>& positions = session.garment(g).particles().positions;
  std::vector<double> depths;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!pinned[i]) depths.push_back(std::max(0.0, -session.contact_with_body(g, positions[i]).distance));
  return depths;
}

} // namespace

void RunStats::add(const Session& session) {
  const FrameTimes& t = session.times();
  const double ms[] = {t.pose, t.proxies, t.broad, t.cloth, t.contact, t.skin, t.total()};
  for (std::size_t k = 0; k < stages_.size(); ++k) stages_[k].ms.add(ms[k]);
  const proxies::SweptColliders colliders = session.colliders().swept();
  history_.resize(scene_->garments.size());
  for (std::size_t g = 0; g < scene_->garments.size(); ++g) {
    const cloth::Garment& garment = scene_->garments[g];
    const cloth::Particles& particles = session.garment(static_cast<int>(g)).particles();
    for (const double depth : session.collides_with_body()
                                  ? depths_in_body(session, static_cast<int>(g))
                                  : cloth::penetration_of(garment, particles, colliders.end, colliders.ground)) {
      depths_mm_.add(1000.0 * depth);
      inside_ += depth > k_inside_depth;
    }
    for (const double stretch : cloth::stretch_of(garment, particles)) {
      stretches_.add(std::max(0.0, stretch));
      strains_.add(std::abs(stretch));
    }
    History& history = history_[g];
    if (frames_ >= 2)
      jitters_.add(
          cloth::jitter_of(garment, history.before_last, history.last, particles.positions, session.frame_seconds()));
    history.before_last.swap(history.last);
    history.last = particles.positions;
  }
  ++frames_;
}

nlohmann::json RunStats::json(const Session& session) const {
  nlohmann::json ms;
  for (const Stage& stage : stages_)
    ms[stage.name] = {{"median", stage.ms.percentile(0.5)}, {"p99", stage.ms.percentile(0.99)}};
  nlohmann::json result = {
      {"scene", scene_->name()},
      {"frames", frames_},
      {"seed", 0}, // nothing in a run is random
      {"solver", name_of(scene_->settings.solver)},
      {"substeps", substeps_json(session)},
      {"backend", session.backend()},
      {"threads", session.threads()},
      {"ms_per_frame", ms},
      {"penetration_mm", {{session.collides_with_body() ? "body" : "proxies", json_of(depths_mm_.spread())}}},
      {"share_inside",
       static_cast<double>(inside_) / static_cast<double>(std::max<std::int64_t>(1, depths_mm_.count()))},
      {"stretch", json_of(stretch())},
      {"jitter", jitters_.spread().mean},
      {"diverged", session.failure().has_value()},
      {"recoveries", session.troubles().recoveries},
      {"teleports", session.troubles().teleports},
      {"state_hash", fmt::format("{:016x}", session.state_hash())}};
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

cloth::Spread RunStats::stretch() const {
  cloth::Spread result = stretches_.spread();
  result.mean = strains_.spread().mean;
  return result;
}

std::string RunStats::text(const Session& session) const {
  int particles = 0;
  for (const cloth::Garment& garment : scene_->garments) particles += garment.particle_count();
  std::string text = fmt::format(
      "{}: {} frames ({:.2f} s), {} garments of {} particles, {} proxies ({}), {}, {} substeps a frame\n",
      scene_->name(), frames_, frames_ * session.frame_seconds(), scene_->garments.size(), particles,
      session.colliders().size(), session.backend(), name_of(scene_->settings.solver), scene_->settings.substeps);
  if (frames_ == 0) return text;
  text += "ms a frame, median (p99):";
  for (const Stage& stage : stages_)
    text += fmt::format("  {} {:.3f} ({:.3f})", stage.name, stage.ms.percentile(0.5), stage.ms.percentile(0.99));
  const cloth::Spread depth = depths_mm_.spread(), stretch = this->stretch();
  text += fmt::format("\ninto {}: {:.2f} mm at most, {:.3f} mean   threads longer by {:.1f} % at most, {:.1f} "
                      "p99, off by {:.1f} mean   "
                      "jitter: {:.2f} m/s2\nstate hash {:016x}\n",
                      session.collides_with_body() ? "the body" : "proxies", depth.max, depth.mean, 100 * stretch.max,
                      100 * stretch.p99, 100 * stretch.mean, jitters_.spread().mean, session.state_hash());
  const RunTroubles& troubles = session.troubles();
  if (troubles.frames_split > 0)
    text += fmt::format("{} frames in more substeps than asked, at most {} in frame {} ({})\n", troubles.frames_split,
                        troubles.worst_split.substeps, troubles.worst_split_frame, session.worst_split_reason());
  if (troubles.teleports > 0) text += fmt::format("{} jumps of the body, garments carried along\n", troubles.teleports);
  if (troubles.recoveries > 0) text += fmt::format("{} recoveries\n", troubles.recoveries);
  return text;
}

} // namespace tutu::app
