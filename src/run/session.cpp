#include "src/run/session.h"

#include "cloth/state/tolerances.h"
#include "src/base/stopwatch.h"

#include <algorithm>
#include <fmt/format.h>

namespace tutu::app {
namespace {

constexpr double k_ground_friction = 0.5; // Coulomb: cloth on a wooden stage
constexpr double k_skin_friction = 0.3;   // Coulomb: as proxies have it unless they say otherwise

std::unique_ptr<proxies::CollisionQuery> query_of(const Scene& scene) {
  if (!scene.collides_with_body()) return proxies::make_query(scene.settings.backend);
  return proxies::make_mesh_query(body_of(scene.character));
}

std::optional<proxies::Plane> ground_of(const Scene& scene) {
  if (!scene.ground_height) return std::nullopt;
  return proxies::Plane{Vec3::UnitY(), *scene.ground_height};
}

} // namespace

std::string SessionFailure::message() const {
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

std::string SessionRecovery::message() const {
  const cloth::Divergence& d = recovery.divergence;
  return fmt::format("{} recovered in frame {} (t = {:.4f} s, substep {} of {}): {}; taken again{} with {} substeps",
                     garment, frame, time, d.substep, recovery.first_substeps, cloth::what_was_found(d),
                     recovery.at_rest ? " as a jump, from rest," : "", recovery.substeps);
}

Session::Session(const Scene& scene)
    : scene_(&scene), local_(scene.character.skeleton.rest_local), world_(rig::rest_model(scene.character.skeleton)),
      pins_(scene), colliders_(scene.proxies, ground_of(scene)),
      workers_(std::clamp(scene.settings.threads, 1, std::max(1, static_cast<int>(scene.garments.size())))),
      palette_(scene.character.skin.slot_count()), body_positions_(scene.character.mesh.positions.size()),
      body_normals_(scene.character.mesh.positions.size()) {
  for (const cloth::Garment& garment : scene.garments) {
    garments_.emplace_back(cloth::make_solver(garment, scene.settings), garment);
    pins_start_.emplace_back(garment.pins.size());
    pins_end_.emplace_back(garment.pins.size());
    queries_.push_back(query_of(scene));
  }
  garment_frames_.resize(garments_.size());
  if (!collides_with_body())
    for (const proxies::Proxy& proxy : colliders_.proxies()) friction_.push_back(proxy.friction);
  friction_.push_back(k_ground_friction);
  friction_.push_back(k_skin_friction);
  troubles_.first_recoveries.reserve(SessionTroubles::k_kept);
  // The rest pose until somebody starts the clip: garments are built around it.
  colliders_.reset(world_);
  reset_body();
  place_pins(pins_end_);
}

void Session::pose_at(double time) { rig::pose_at(scene_->clip, scene_->character.skeleton, time, local_, world_); }

void Session::place_pins(GarmentPositions& targets) {
  for (std::size_t g = 0; g < garments_.size(); ++g) pins_.place(g, world_, targets[g]);
}

void Session::start(const GarmentPositions& garment_positions) {
  start_positions_ = garment_positions;
  start_time_ = 0.0;
  frame_ = 0;
  failure_.reset();
  stopped_ = false;
  times_ = {};
  troubles_ = {};
  troubles_.first_recoveries.reserve(SessionTroubles::k_kept);
  pose_at(0.0);
  start_world_ = world_;
  colliders_.reset(world_);
  reset_body();
  place_pins(pins_end_);
  for (std::size_t g = 0; g < garments_.size(); ++g) garments_[g].reset(garment_positions[g]);
}

void Session::jump(double time) {
  const bool failed = failure_.has_value(); // then what there is cannot be carried along: the start can
  const std::vector<Transform> before = failed ? start_world_ : world_;
  start_time_ = time - frame_ * frame_seconds();
  failure_.reset();
  stopped_ = false;
  pose_at(time);
  colliders_.reset(world_);
  reset_body();
  place_pins(pins_end_);
  if (failed)
    for (std::size_t g = 0; g < garments_.size(); ++g) garments_[g].reset(start_positions_[g]);
  carry_along(before);
}

int Session::holding_joint(std::size_t g) const {
  return scene_->attachment_joints[g].empty() ? 0 : scene_->attachment_joints[g].front();
}

void Session::carry_along(std::span<const Transform> before) {
  for (std::size_t g = 0; g < garments_.size(); ++g) {
    const int joint = holding_joint(g);
    const Transform carry = world_[joint] * before[joint].inverse();
    std::vector<Vec3> positions = garments_[g].particles().positions;
    for (Vec3& p : positions) p = carry * p;
    garments_[g].reset(positions);
  }
}

bool Session::has_jumped() const {
  for (std::size_t g = 0; g < garments_.size(); ++g) {
    const int joint = holding_joint(g);
    const double way = (world_[joint].translation - world_before_[joint].translation).norm();
    if (way > k_teleport_speed * frame_seconds()) return true;
  }
  return false;
}

void Session::advance() {
  if (failure_ || stopped_) return;
  Stopwatch watch;
  // The body moves first: garments see where it was and where it comes to.
  rig::sample(scene_->clip, scene_->clip.times.front() + time() + frame_seconds(), local_);
  const double sampling = watch.lap();
  advance_to(local_, 0.0);
  times_.pose += sampling;
}

void Session::advance_to(std::span<const Transform> local, double extra_drag) {
  if (failure_ || stopped_) return;
  times_ = {};
  Stopwatch watch;
  if (local.data() != local_.data()) local_.assign(local.begin(), local.end());
  world_before_ = world_;
  rig::model_from_local(scene_->character.skeleton, local_, world_);
  times_.pose = watch.lap();
  follow_body();
  watch.lap();
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
  times_.proxies = watch.lap();

  frame_is_split_ = false;
  advance_garments(extra_drag);
  troubles_.frames_split += frame_is_split_;
  if (!failure_ && !stopped_) ++frame_;
}

void Session::advance_garments(double extra_drag) {
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

void Session::advance_garment(std::size_t g, double extra_drag) {
  cloth::GuardedSolver& solver = garments_[g];
  GarmentFrame& frame = garment_frames_[g];
  cloth::FrameInput input;
  input.colliders = colliders_.swept(); // of the true body, too, they tell how many substeps are needed
  input.friction = friction_;
  input.pins_start = pins_start_[g];
  input.pins_end = pins_end_[g];
  input.seconds = frame_seconds();
  input.substeps = scene_->settings.substeps;
  input.extra_drag = extra_drag;
  input.stop = stop_;
  frame.planning = 0.0;
  if (scene_->settings.adaptive_substeps) {
    Stopwatch watch;
    frame.plan =
        cloth::plan_substeps(input, cloth::extent_of(solver.particles()), scene_->garments[g].fabric.contact_offset());
    input.substeps = frame.plan.substeps;
    frame.planning = watch.lap();
  }
  if (collides_with_body()) input.colliders = {{}, {}, colliders_.ground(), {}, body_start_, body_end_};
  frame.end = solver.step(input, *queries_[g]);
}

void Session::note_garment(std::size_t g) {
  const std::string& name = scene_->garments[g].name;
  const GarmentFrame& frame = garment_frames_[g];
  if (frame.end && std::holds_alternative<cloth::Stopped>(*frame.end)) stopped_ = true;
  if (scene_->settings.adaptive_substeps && frame.plan.split(scene_->settings.substeps)) note_split(g, frame.plan);
  if (const auto& recovery = garments_[g].recovery()) {
    const cloth::Divergence& bad = recovery->divergence;
    const double moment = time() + frame_seconds() * (bad.substep + 1) / recovery->first_substeps;
    if (frame.end) {
      if (!failure_)
        failure_ = SessionFailure{name,
                                  bad,
                                  frame_,
                                  moment,
                                  recovery->tries,
                                  recovery->substeps,
                                  recovery->worn_out,
                                  recovery->first_substeps};
    } else {
      ++troubles_.recoveries;
      if (troubles_.first_recoveries.size() < SessionTroubles::k_kept)
        troubles_.first_recoveries.push_back({name, *recovery, frame_, moment});
    }
  }
  const cloth::SolverTimes& t = garments_[g].times();
  times_.broad += t.broad + frame.planning;
  times_.cloth += t.cloth;
  times_.contact += t.contact;
}

void Session::note_split(std::size_t g, const cloth::SubstepPlan& plan) {
  frame_is_split_ = true;
  if (plan.substeps <= troubles_.worst_split.substeps) return;
  troubles_.worst_split = plan;
  troubles_.worst_split_frame = frame_;
  troubles_.worst_split_reason =
      scene_->garments[g].name + ": " + plan.reason(colliders_.proxies()[plan.collider].name);
}

void Session::follow_body() {
  if (!collides_with_body()) return;
  body_start_.swap(body_end_);
  skin_body();
  body_end_ = body_positions_;
}

void Session::reset_body() {
  follow_body();
  body_start_ = body_end_;
}

void Session::skin_body() {
  Stopwatch watch;
  rig::skinning_palette(scene_->character.skin, world_, palette_);
  rig::skin_vertices(scene_->character.mesh, scene_->character.skin, palette_, body_positions_, body_normals_);
  times_.skin += watch.lap();
}

std::uint64_t Session::state_hash() const {
  std::uint64_t hash = cloth::state_hash({});
  for (const auto& garment : garments_) hash = cloth::state_hash(garment.particles(), hash);
  return hash;
}

} // namespace tutu::app
