#include "src/run/runtime.h"

#include "cloth/state/tolerances.h"
#include "src/base/stopwatch.h"
#include "src/run/met_colliders.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace tutu::app {
namespace {

constexpr double k_ground_friction = 0.5; // Coulomb: cloth on a wooden stage
constexpr double k_skin_friction = 0.3;   // Coulomb: as proxies have it unless they say otherwise

std::unique_ptr<proxies::CollisionQuery> query_of(const Wearer& wearer) {
  if (!wearer.collides_with_body()) return proxies::make_query(wearer.settings.backend);
  return proxies::make_mesh_query(body_of(wearer.character));
}

std::optional<proxies::Plane> ground_of(const Wearer& wearer) {
  if (!wearer.ground_height) return std::nullopt;
  return proxies::Plane{Vec3::UnitY(), *wearer.ground_height};
}

/// As long as the settings' own substeps, or a little shorter.
int substeps_in(double seconds, const RunSettings& settings) {
  const double wanted = settings.substeps * seconds * settings.frames_per_second;
  return std::max(1, static_cast<int>(std::ceil(wanted - 1e-6)));
}

} // namespace

std::string RunFailure::message() const {
  std::string text =
      fmt::format("{} diverged in frame {} (t = {:.4f} s, substep {}{}): {}", garment, frame, time, divergence.substep,
                  substeps > 0 ? fmt::format(" of {}", substeps) : "", cloth::what_was_found(divergence));
  if (worn_out)
    text += fmt::format("; it held only as a jump, from rest, for the {}th frame in a row", cloth::k_stops_in_a_row);
  else if (tries > 0)
    text += fmt::format("; {} tries with smaller substeps, the last with {} a frame, did not hold either", tries,
                        last_substeps);
  return text;
}

std::string RunRecovery::message() const {
  const cloth::Divergence& d = recovery.divergence;
  return fmt::format("{} recovered in frame {} (t = {:.4f} s, substep {} of {}): {}; taken again{} with {} substeps",
                     garment, frame, time, d.substep, recovery.first_substeps, cloth::what_was_found(d),
                     recovery.at_rest ? " as a jump, from rest," : "", recovery.substeps);
}

Runtime::Runtime(const Wearer& wearer)
    : wearer_(&wearer), world_(rig::rest_model(wearer.character.skeleton)), pins_(wearer),
      colliders_(wearer.proxies, ground_of(wearer)),
      workers_(std::clamp(wearer.settings.threads, 1, std::max(1, static_cast<int>(wearer.garments.size())))),
      world_before_(world_), palette_(wearer.character.skin.slot_count()),
      body_positions_(wearer.character.mesh.positions.size()), body_normals_(body_positions_.size()) {
  int most = 0;
  for (const cloth::Garment& garment : wearer.garments) {
    garments_.emplace_back(cloth::make_solver(garment, wearer.settings), garment);
    pins_start_.emplace_back(garment.pins.size());
    pins_end_.emplace_back(garment.pins.size());
    queries_.push_back(query_of(wearer));
    ignored_.push_back(ignored_by(garment, colliders_.proxies(), wearer.character.skeleton));
    most = std::max(most, garment.particle_count());
  }
  carried_.reserve(most);
  garment_frames_.resize(garments_.size());
  if (!collides_with_body())
    for (const proxies::Proxy& proxy : colliders_.proxies()) friction_.push_back(proxy.friction);
  friction_.push_back(k_ground_friction);
  friction_.push_back(k_skin_friction);
  troubles_.first_recoveries.reserve(RunTroubles::k_kept);
  set_wind(wearer.wind);
  count_from(0.0, wearer.settings.frame_seconds());
  stand_still();
}

void Runtime::set_wind(const cloth::Wind& wind) {
  const bool gusts = !wind.gusts || (wind.gusts->speed >= 0.0 && wind.gusts->speed <= cloth::k_fastest_wind &&
                                     wind.gusts->period >= cloth::k_shortest_gust);
  if (!gusts || !(wind.velocity.norm() <= cloth::k_fastest_wind))
    throw std::invalid_argument(fmt::format("a wind that is none; expected at most {} m/s, and gusts of at least {} s",
                                            cloth::k_fastest_wind, cloth::k_shortest_gust));
  wind_ = wind;
}

void Runtime::set_pose(std::span<const Transform> world) {
  if (world.size() != world_.size())
    throw std::invalid_argument(fmt::format("{} joints; the skeleton has {}", world.size(), world_.size()));
  std::copy(world.begin(), world.end(), world_.begin());
}

void Runtime::count_from(double time, double seconds) {
  start_time_ = time;
  start_frame_ = frame_;
  seconds_ = seconds;
  substeps_ = substeps_in(seconds, wearer_->settings);
}

void Runtime::stand_still() {
  colliders_.reset(world_);
  reset_body();
  place_pins(pins_end_);
}

void Runtime::place_pins(GarmentPositions& targets) {
  for (std::size_t g = 0; g < garments_.size(); ++g) pins_.place(g, world_, targets[g]);
}

void Runtime::start(std::span<const Transform> world, const GarmentPositions& garment_positions, double time) {
  set_pose(world);
  start_positions_ = garment_positions;
  start_world_ = world_;
  frame_ = 0;
  count_from(time, seconds_);
  failure_.reset();
  stopped_ = false;
  times_ = {};
  troubles_ = {};
  troubles_.first_recoveries.reserve(RunTroubles::k_kept);
  stand_still();
  for (std::size_t g = 0; g < garments_.size(); ++g) garments_[g].reset(garment_positions[g]);
}

void Runtime::jump(std::span<const Transform> world, double time) {
  const bool failed = failure_.has_value(); // then what there is cannot be carried along: the start can
  world_before_ = failed ? start_world_ : world_;
  set_pose(world);
  start_time_ = time - (frame_ - start_frame_) * seconds_;
  failure_.reset();
  stopped_ = false;
  stand_still();
  if (failed)
    for (std::size_t g = 0; g < garments_.size(); ++g) garments_[g].reset(start_positions_[g]);
  carry_along(world_before_);
}

int Runtime::holding_joint(std::size_t g) const {
  return wearer_->attachment_joints[g].empty() ? 0 : wearer_->attachment_joints[g].front();
}

void Runtime::carry_along(std::span<const Transform> before) {
  for (std::size_t g = 0; g < garments_.size(); ++g) {
    const int joint = holding_joint(g);
    const Transform carry = world_[joint] * before[joint].inverse();
    carried_ = garments_[g].particles().positions;
    for (Vec3& p : carried_) p = carry * p;
    garments_[g].reset(carried_);
  }
}

bool Runtime::has_jumped() const {
  for (std::size_t g = 0; g < garments_.size(); ++g) {
    const int joint = holding_joint(g);
    const double way = (world_[joint].translation - world_before_[joint].translation).norm();
    if (way > k_teleport_speed * seconds_) return true;
  }
  return false;
}

void Runtime::step(std::span<const Transform> world, double seconds, double extra_drag) {
  if (!(seconds > 0.0 && seconds <= k_longest_frame))
    throw std::invalid_argument(fmt::format("a frame of {} s; expected above 0, at most {}", seconds, k_longest_frame));
  if (failure_ || stopped_) return;
  if (seconds != seconds_) count_from(time(), seconds);
  times_ = {};
  world_before_ = world_;
  set_pose(world);
  // The body moves first: garments see where it was and where it comes to.
  follow_body();
  Stopwatch watch;
  colliders_.advance(world_);
  pins_start_.swap(pins_end_);
  place_pins(pins_end_);
  if (has_jumped()) {
    ++troubles_.teleports;
    colliders_.reset(world_);
    body_start_ = body_end_;
    for (std::size_t g = 0; g < garments_.size(); ++g) pins_start_[g] = pins_end_[g];
    carry_along(world_before_);
  }
  wind_start_ = cloth::wind_at(wind_, time());
  wind_end_ = cloth::wind_at(wind_, time() + seconds_);
  times_.proxies = watch.lap();

  frame_is_split_ = false;
  advance_garments(extra_drag);
  troubles_.frames_split += frame_is_split_;
  if (!failure_ && !stopped_) ++frame_;
}

void Runtime::advance_garments(double extra_drag) {
  Stopwatch watch;
  const FrameTimes before = times_;
  workers_.for_each(garments_.size(), [&](std::size_t g) { advance_garment(g, extra_drag); });
  for (std::size_t g = 0; g < garments_.size(); ++g) note_garment(g);
  if (workers_.count() == 1) return;
  // What was done side by side is told as the share of the time that passed.
  const double share = watch.lap() / std::max(1e-9, times_.total() - before.total());
  times_.broad *= share;
  times_.cloth *= share;
  times_.contact *= share;
}

void Runtime::advance_garment(std::size_t g, double extra_drag) {
  cloth::GuardedSolver& solver = garments_[g];
  GarmentFrame& frame = garment_frames_[g];
  cloth::FrameInput input;
  input.colliders = colliders_of(static_cast<int>(g)); // of the true body, too, they tell how many substeps are needed
  input.friction = friction_;
  input.pins_start = pins_start_[g];
  input.pins_end = pins_end_[g];
  input.seconds = seconds_;
  input.substeps = substeps_;
  input.wind_start = wind_start_;
  input.wind_end = wind_end_;
  input.extra_drag = extra_drag;
  input.stop = stop_;
  frame.planning = 0.0;
  if (wearer_->settings.adaptive_substeps) {
    Stopwatch watch;
    frame.plan =
        cloth::plan_substeps(input, cloth::extent_of(solver.particles()), wearer_->garments[g].fabric.contact_offset());
    input.substeps = frame.plan.substeps;
    frame.planning = watch.lap();
  }
  if (collides_with_body()) input.colliders = {{}, {}, colliders_.ground(), {}, body_start_, body_end_};
  frame.end = solver.step(input, *queries_[g]);
}

void Runtime::note_garment(std::size_t g) {
  const GarmentFrame& frame = garment_frames_[g];
  if (frame.end && std::holds_alternative<cloth::Stopped>(*frame.end)) stopped_ = true;
  if (wearer_->settings.adaptive_substeps && frame.plan.split(substeps_)) {
    frame_is_split_ = true;
    if (frame.plan.substeps > troubles_.worst_split.substeps) {
      troubles_.worst_split = frame.plan;
      troubles_.worst_split_frame = frame_;
      troubles_.worst_split_garment = static_cast<int>(g);
    }
  }
  if (const auto& recovery = garments_[g].recovery()) {
    const std::string& name = wearer_->garments[g].name;
    const cloth::Divergence& bad = recovery->divergence;
    const double moment = time() + seconds_ * (bad.substep + 1) / recovery->first_substeps;
    if (frame.end) {
      if (!failure_)
        failure_ = RunFailure{name,
                              bad,
                              frame_,
                              moment,
                              recovery->tries,
                              recovery->substeps,
                              recovery->worn_out,
                              recovery->first_substeps};
    } else {
      ++troubles_.recoveries;
      if (troubles_.first_recoveries.size() < RunTroubles::k_kept)
        troubles_.first_recoveries.push_back({name, *recovery, frame_, moment});
    }
  }
  const cloth::SolverTimes& t = garments_[g].times();
  times_.broad += t.broad + frame.planning;
  times_.cloth += t.cloth;
  times_.contact += t.contact;
}

std::string Runtime::worst_split_reason() const {
  if (troubles_.frames_split == 0) return "";
  const cloth::SubstepPlan& plan = troubles_.worst_split;
  return wearer_->garments[troubles_.worst_split_garment].name + ": " +
         plan.reason(colliders_.proxies()[plan.collider].name);
}

void Runtime::normals(int g, std::span<Vec3> out) const {
  const std::span<const Vec3> x = positions(g);
  std::fill(out.begin(), out.end(), Vec3::Zero());
  for (const auto& t : wearer_->garments[g].triangles) {
    const Vec3 doubled = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
    for (const std::uint32_t corner : t) out[corner] += doubled;
  }
  for (Vec3& n : out) {
    const double length = n.norm();
    n = length > 0.0 ? Vec3(n / length) : Vec3::UnitY();
  }
}

void Runtime::follow_body() {
  if (!collides_with_body()) return;
  body_start_.swap(body_end_);
  skin_body();
  body_end_ = body_positions_;
}

void Runtime::reset_body() {
  follow_body();
  body_start_ = body_end_;
}

void Runtime::skin_body() {
  Stopwatch watch;
  rig::skinning_palette(wearer_->character.skin, world_, palette_);
  rig::skin_vertices(wearer_->character.mesh, wearer_->character.skin, palette_, body_positions_, body_normals_);
  times_.skin += watch.lap();
}

std::uint64_t Runtime::state_hash() const {
  std::uint64_t hash = cloth::state_hash({});
  for (const auto& garment : garments_) hash = cloth::state_hash(garment.particles(), hash);
  return hash;
}

} // namespace tutu::app
