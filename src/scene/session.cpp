#include "src/scene/session.h"

#include <chrono>
#include <fmt/format.h>

namespace tutu::app {
namespace {

class Stopwatch {
public:
  /// Milliseconds since the last call or construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

constexpr double k_ground_friction = 0.5; // Coulomb: cloth on a wooden stage

std::optional<proxies::Plane> ground_of(const SceneDescription& description) {
  if (!description.ground_height) return std::nullopt;
  return proxies::Plane{Vec3::UnitY(), *description.ground_height};
}

} // namespace

std::string SessionFailure::message() const {
  const Vec3& p = divergence.position;
  return fmt::format("{} diverged in frame {} (t = {:.4f} s, substep {}): an edge at particle {} ({:.6g}, {:.6g}, "
                     "{:.6g}) is stretched by {:.6g} %; the largest force is {:.3g} N on particle {}",
                     garment, frame, time, divergence.substep, divergence.particle, p.x(), p.y(), p.z(),
                     100.0 * divergence.stretch, divergence.strongest_force, divergence.strongest_particle);
}

Session::Session(const Scene& scene)
    : scene_(&scene), local_(scene.character.skeleton.rest_local), world_(rig::rest_model(scene.character.skeleton)),
      colliders_(scene.proxies, ground_of(scene.description)), query_(proxies::make_query(scene.description.backend)),
      palette_(scene.character.skin.slot_count()), body_positions_(scene.character.mesh.positions.size()),
      body_normals_(scene.character.mesh.positions.size()) {
  for (const Transform& joint : world_) rest_inverse_.push_back(joint.inverse());
  for (const cloth::Garment& garment : scene.garments) {
    garments_.push_back(cloth::make_solver(scene.description.solver, garment));
    pins_start_.emplace_back(garment.pins.size());
    pins_end_.emplace_back(garment.pins.size());
  }
  for (const proxies::Proxy& proxy : colliders_.proxies()) friction_.push_back(proxy.friction);
  friction_.push_back(k_ground_friction);
  // The rest pose until somebody starts the clip: garments are built around it.
  colliders_.reset(world_);
  place_pins(pins_end_);
}

void Session::pose_at(double time) {
  rig::sample(scene_->clip, scene_->clip.times.front() + time, local_);
  rig::model_from_local(scene_->character.skeleton, local_, world_);
}

void Session::place_pins(std::vector<std::vector<Vec3>>& targets) const {
  for (std::size_t g = 0; g < garments_.size(); ++g) {
    const cloth::Garment& garment = scene_->garments[g];
    for (std::size_t k = 0; k < garment.pins.size(); ++k) {
      const int joint = scene_->attachment_joints[g][garment.pins[k].attachment];
      targets[g][k] = world_[joint] * (rest_inverse_[joint] * garment.rest_positions[garment.pins[k].particle]);
    }
  }
}

void Session::start(const std::vector<std::vector<Vec3>>& garment_positions) {
  start_positions_ = garment_positions;
  start_time_ = 0.0;
  frame_ = 0;
  failure_.reset();
  times_ = {};
  pose_at(0.0);
  start_world_ = world_;
  colliders_.reset(world_);
  place_pins(pins_end_);
  for (std::size_t g = 0; g < garments_.size(); ++g) garments_[g]->reset(garment_positions[g]);
}

void Session::jump(double time) {
  const bool failed = failure_.has_value(); // then what there is cannot be carried along: the start can
  const std::vector<Transform> before = failed ? start_world_ : world_;
  start_time_ = time - frame_ * frame_seconds();
  failure_.reset();
  pose_at(time);
  colliders_.reset(world_);
  place_pins(pins_end_);
  for (std::size_t g = 0; g < garments_.size(); ++g) {
    const int joint = scene_->attachment_joints[g].empty() ? 0 : scene_->attachment_joints[g].front();
    const Transform carry = world_[joint] * before[joint].inverse();
    std::vector<Vec3> positions = failed ? start_positions_[g] : garments_[g]->particles().positions;
    for (Vec3& p : positions) p = carry * p;
    garments_[g]->reset(positions);
  }
}

void Session::advance() {
  if (failure_) return;
  Stopwatch watch;
  // The body moves first: garments see where it was and where it comes to.
  rig::sample(scene_->clip, scene_->clip.times.front() + time() + frame_seconds(), local_);
  const double sampling = watch.lap();
  advance_to(local_, 0.0);
  times_.pose += sampling;
}

void Session::advance_to(std::span<const Transform> local, double extra_drag) {
  if (failure_) return;
  times_ = {};
  Stopwatch watch;
  if (local.data() != local_.data()) local_.assign(local.begin(), local.end());
  rig::model_from_local(scene_->character.skeleton, local_, world_);
  times_.pose = watch.lap();
  colliders_.advance(world_);
  pins_start_.swap(pins_end_);
  place_pins(pins_end_);
  times_.proxies = watch.lap();

  for (std::size_t g = 0; g < garments_.size() && !failure_; ++g) {
    cloth::FrameInput input;
    input.colliders = colliders_.swept();
    input.friction = friction_;
    input.pins_start = pins_start_[g];
    input.pins_end = pins_end_[g];
    input.seconds = frame_seconds();
    input.substeps = scene_->description.substeps;
    input.extra_drag = extra_drag;
    if (const auto divergence = garments_[g]->step(input, *query_)) {
      const double moment = time() + frame_seconds() * (divergence->substep + 1) / input.substeps;
      failure_ = SessionFailure{scene_->garments[g].name, *divergence, frame_, moment};
    }
    const cloth::SolverTimes& t = garments_[g]->times();
    times_.broad += t.broad;
    times_.cloth += t.cloth;
    times_.contact += t.contact;
  }
  if (!failure_) ++frame_;
}

void Session::skin_body() {
  Stopwatch watch;
  rig::skinning_palette(scene_->character.skin, world_, palette_);
  rig::skin_vertices(scene_->character.mesh, scene_->character.skin, palette_, body_positions_, body_normals_);
  times_.skin += watch.lap();
}

std::uint64_t Session::state_hash() const {
  std::uint64_t hash = cloth::state_hash({});
  for (const auto& garment : garments_) hash = cloth::state_hash(garment->particles(), hash);
  return hash;
}

} // namespace tutu::app
