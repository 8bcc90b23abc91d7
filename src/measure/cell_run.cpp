#include "src/measure/cell_run.h"

#include "proxies/distance/signed_distance.h"
#include "rig/error.h"
#include "src/run/posed_body.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <limits>

namespace tutu::app {
namespace {

constexpr double k_gravity = 9.81;      // m/s2, as FrameInput has it
constexpr double k_settling_drag = 4.0; // 1/s, as when garments are draped

/// ms: of this thread, or with more than one of the wall.
double now_ms(int threads) {
  if (threads > 1)
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

GarmentPositions positions_of(const Session& session) {
  GarmentPositions positions;
  for (std::size_t g = 0; g < session.scene().garments.size(); ++g)
    positions.push_back(session.garment(static_cast<int>(g)).particles().positions);
  return positions;
}

/// Signed distance of a particle from all that its garment collides with, m.
double distance_to_colliders(const Session& session, int g, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  const proxies::SweptColliders colliders = session.colliders_of(g);
  if (session.collides_with_body()) nearest = session.contact_with_body(g, p).distance;
  else
    for (int c = 0; c < colliders.size(); ++c)
      if (colliders.meets(c)) nearest = std::min(nearest, proxies::signed_distance(p, colliders.end[c]).distance);
  if (colliders.ground) nearest = std::min(nearest, proxies::signed_distance(p, *colliders.ground).distance);
  return nearest;
}

/// Kinetic, of height, and of the springs that the solver knows, J.
double energy_of(const Session& session) {
  double energy = 0.0;
  for (std::size_t g = 0; g < session.scene().garments.size(); ++g) {
    const cloth::Garment& garment = session.scene().garments[g];
    const cloth::Particles& particles = session.garment(static_cast<int>(g)).particles();
    for (int i = 0; i < particles.count(); ++i)
      energy +=
          garment.masses[i] * (0.5 * particles.velocities[i].squaredNorm() + k_gravity * particles.positions[i].y());
    const bool bends = session.scene().settings.solver == cloth::SolverKind::mass_spring;
    for (const cloth::Spring& spring : garment.springs) {
      if (spring.kind == cloth::SpringKind::bend && !bends) continue;
      const double longer = (particles.positions[spring.j] - particles.positions[spring.i]).norm() - spring.rest_length;
      energy += 0.5 * spring.stiffness * longer * longer;
    }
  }
  return energy;
}

class Measuring {
public:
  Measuring(const Scene& scene, CellRun& run)
      : scene_(&scene), run_(&run), body_(scene), mesh_(body_of(scene.character)) {
    for (const cloth::Garment& garment : scene.garments) probes_.emplace_back(garment);
  }

  void after_frame(const Session& session) {
    for (std::size_t g = 0; g < scene_->garments.size(); ++g) {
      const std::vector<Vec3>& positions = session.garment(static_cast<int>(g)).particles().positions;
      strains_.add(probes_[g].parts(), positions);
      if (session.collides_with_body()) continue;
      found_.clear();
      probes_[g].measure(session.colliders_of(static_cast<int>(g)), positions, found_);
      for (const double depth : found_.particle_depths) in_proxies_.add(depth);
      run_->surface_in_proxies = std::max(run_->surface_in_proxies, found_.surface);
    }
  }

  void at_moment(const Session& session) {
    body_.pose_at(session.time());
    mesh_.pose(body_.positions());
    for (std::size_t g = 0; g < probes_.size(); ++g) {
      found_.clear();
      probes_[g].measure(mesh_, session.garment(static_cast<int>(g)).particles().positions, found_);
      for (const double depth : found_.particle_depths) in_body_.add(depth);
      inside_.add(found_.particles);
      run_->surface_in_body = std::max(run_->surface_in_body, found_.surface);
    }
  }

  void while_held(const Session& session) {
    const GarmentPositions now = positions_of(session);
    if (!before_last_.empty())
      for (std::size_t g = 0; g < now.size(); ++g)
        jitter_.add(cloth::jitter_of(probes_[g].parts(), before_last_[g], last_[g], now[g], session.frame_seconds()));
    before_last_ = std::move(last_);
    last_ = now;
    const double energy = energy_of(session);
    least_energy_ = std::min(least_energy_, energy);
    run_->energy_rise = std::max(run_->energy_rise, energy - least_energy_);
  }

  void finish(Session& session) {
    session.skin_body();
    mesh_.pose(session.body_positions());
    run_->end = end_of(session, probes_, &mesh_);
    run_->in_proxies = in_proxies_.spread();
    run_->in_body = in_body_.spread();
    run_->share_in_body =
        static_cast<double>(inside_.inside) / static_cast<double>(std::max<std::int64_t>(1, inside_.asked));
    run_->strains = strains_.strains();
    run_->jitter = jitter_.spread().mean;
  }

private:
  const Scene* scene_;
  CellRun* run_;
  PosedBody body_;
  proxies::BodyMesh mesh_;
  std::vector<ClothProbe> probes_;
  ClothDepths found_;
  DepthCount inside_;
  cloth::SpreadGatherer in_proxies_, in_body_, jitter_;
  cloth::ThreadStrainGatherer strains_;
  GarmentPositions last_, before_last_;
  double least_energy_ = std::numeric_limits<double>::infinity();
};

Trajectory::Moment moment_of(const Session& session) {
  Trajectory::Moment moment{session.time(), positions_of(session), {}};
  for (std::size_t g = 0; g < moment.positions.size(); ++g) {
    const cloth::Garment& garment = session.scene().garments[g];
    const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment);
    std::vector<std::uint8_t>& touching = moment.touching.emplace_back(moment.positions[g].size());
    for (std::size_t i = 0; i < touching.size(); ++i)
      touching[i] = !pinned[i] && distance_to_colliders(session, static_cast<int>(g), moment.positions[g][i]) <
                                      touching_distance(garment);
  }
  return moment;
}

} // namespace

double touching_distance(const cloth::Garment& garment) { return garment.fabric.contact_offset() + k_contact_slack; }

Protocol at_rate(const Protocol& protocol, double scene_rate, double rate) {
  const auto convert = [&](int frames) {
    constexpr double k_rounding = 1e-6; // of a frame: rates have fractions, 59.94 is twice 29.97
    const double converted = frames * rate / scene_rate;
    if (std::abs(converted - std::round(converted)) > k_rounding)
      throw InputError("", "frames_per_second", fmt::format("{}", rate),
                       fmt::format("a rate at which {} frames of {} a second are whole frames", frames, scene_rate));
    return static_cast<int>(std::lround(converted));
  };
  return {convert(protocol.frames), convert(protocol.settle), convert(protocol.held), convert(protocol.every)};
}

CellRun run_cell(const Scene& scene, const GarmentPositions& start, const Protocol& protocol, bool measured,
                 const std::function<bool(const CellRun&)>& go_on) {
  CellRun run;
  std::optional<Measuring> measuring;
  if (measured) measuring.emplace(scene, run);
  Session session(scene);
  session.start(start);
  const auto alive = [&] { return !session.failure() && !run.stopped; };
  const auto frame = [&](const std::function<void()>& take, const std::function<void()>& look) {
    take();
    if (!session.failure()) look();
    if (!go_on(run)) run.stopped = true;
  };

  for (int f = 1; f <= protocol.frames && alive(); ++f) {
    double ms = 0.0;
    frame(
        [&] {
          const double before = now_ms(session.threads());
          session.advance();
          ms = now_ms(session.threads()) - before;
        },
        [&] {
          run.stages.push_back(session.times());
          run.ms.push_back(ms);
          if (measuring) measuring->after_frame(session);
          if (f % protocol.every != 0) return;
          run.trajectory.moments.push_back(moment_of(session));
          if (measuring) measuring->at_moment(session);
        });
  }
  std::vector<Transform> pose(scene.character.skeleton.rest_local);
  rig::sample(scene.motion, scene.motion.start() + session.time(), pose);
  for (int f = 0; f < protocol.settle && alive(); ++f) frame([&] { session.advance_to(pose, k_settling_drag); }, [] {});
  run.trajectory.drape = positions_of(session);
  for (int f = 0; f < protocol.held && alive(); ++f)
    frame([&] { session.advance_to(pose, 0.0); },
          [&] {
            if (measuring) measuring->while_held(session);
          });

  if (session.failure()) run.failure = session.failure()->message();
  run.recoveries = session.troubles().recoveries;
  run.most_substeps = std::max(scene.settings.substeps, session.troubles().worst_split.substeps);
  run.state_hash = session.state_hash();
  if (measuring) measuring->finish(session);
  return run;
}

} // namespace tutu::app
