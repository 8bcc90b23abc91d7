#include "cloth/mass_spring.h"

#include "cloth/tolerances.h"

#include <chrono>
#include <cmath>

namespace tutu::cloth {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the time since `from` to `sum` (ms) and returns now.
Clock::time_point lap(Clock::time_point from, double& sum) {
  const auto now = Clock::now();
  sum += std::chrono::duration<double, std::milli>(now - from).count();
  return now;
}

} // namespace

std::optional<int> add_spring_forces(const Garment& garment, std::span<const Vec3> positions, std::span<Vec3> forces) {
  std::optional<int> first_bad;
  const int count = static_cast<int>(garment.springs.size());
  for (int k = 0; k < count; ++k) {
    const Spring& spring = garment.springs[k];
    const Vec3 d = positions[spring.j] - positions[spring.i];
    const double length = d.norm();
    // Written so that a length that is not a number fails too.
    if (!(length <= (1.0 + k_diverged_stretch) * spring.rest_length) && k < garment.structural_count && !first_bad)
      first_bad = k;
    if (!(length > 0.0)) continue; // two particles in one place: no direction, no force
    const Vec3 force = (spring.stiffness * (length - spring.rest_length) / length) * d;
    forces[spring.i] += force;
    forces[spring.j] -= force;
  }
  return first_bad;
}

double elastic_energy(const Garment& garment, std::span<const Vec3> positions) {
  double energy = 0.0;
  for (const Spring& spring : garment.springs) {
    const double extension = (positions[spring.j] - positions[spring.i]).norm() - spring.rest_length;
    energy += 0.5 * spring.stiffness * extension * extension;
  }
  return energy;
}

MassSpring::MassSpring(const Garment& garment)
    : garment_(&garment), pinned_(garment.rest_positions.size(), 0), contacts_(garment.fabric.contact_offset()) {
  for (const Pin& pin : garment.pins) pinned_[pin.particle] = 1;
  reset(garment.rest_positions);
}

void MassSpring::reset(std::span<const Vec3> positions) {
  particles_.positions.assign(positions.begin(), positions.end());
  particles_.velocities.assign(positions.size(), Vec3::Zero());
  forces_.assign(positions.size(), Vec3::Zero());
  renew_forces(0);
}

void MassSpring::integrate(const FrameInput& input, double h) {
  const double drag = garment_->fabric.drag + input.extra_drag;
  for (int i = 0; i < particles_.count(); ++i) {
    if (pinned_[i]) continue;
    Vec3& v = particles_.velocities[i];
    v += h * (forces_[i] / garment_->masses[i] + input.gravity - drag * v);
    particles_.positions[i] += h * v;
  }
}

void MassSpring::follow_pins(const FrameInput& input, double s, double h) {
  for (std::size_t k = 0; k < garment_->pins.size(); ++k) {
    const int i = garment_->pins[k].particle;
    const Vec3 target = (1.0 - s) * input.pins_start[k] + s * input.pins_end[k];
    particles_.velocities[i] = (target - particles_.positions[i]) / h;
    particles_.positions[i] = target;
  }
}

void MassSpring::close_seams() {
  for (const Seam& seam : garment_->seams) {
    // A pinned side leads; otherwise both meet at their common centre of mass with their common momentum.
    double share = garment_->masses[seam.j] / (garment_->masses[seam.i] + garment_->masses[seam.j]);
    if (pinned_[seam.i] != pinned_[seam.j]) share = pinned_[seam.j] ? 1.0 : 0.0;
    for (std::vector<Vec3>* field : {&particles_.positions, &particles_.velocities}) {
      Vec3 &a = (*field)[seam.i], &b = (*field)[seam.j];
      a = b = (1.0 - share) * a + share * b;
    }
  }
}

std::optional<Divergence> MassSpring::renew_forces(int substep) {
  std::fill(forces_.begin(), forces_.end(), Vec3::Zero());
  const std::optional<int> bad = add_spring_forces(*garment_, particles_.positions, forces_);
  if (!bad) return std::nullopt;
  const Spring& spring = garment_->springs[*bad];
  Divergence divergence;
  divergence.substep = substep;
  divergence.particle = pinned_[spring.i] ? spring.j : spring.i;
  divergence.position = particles_.positions[divergence.particle];
  const Vec3 d = particles_.positions[spring.j] - particles_.positions[spring.i];
  divergence.stretch = d.norm() / spring.rest_length - 1.0;
  for (int i = 0; i < particles_.count(); ++i)
    if (const double force = forces_[i].norm(); !(force <= divergence.strongest_force)) {
      divergence.strongest_force = force;
      divergence.strongest_particle = i;
      if (std::isnan(force)) break;
    }
  return divergence;
}

std::optional<Divergence> MassSpring::step(const FrameInput& input, proxies::CollisionQuery& query) {
  times_ = {};
  auto time = Clock::now();
  contacts_.begin_frame(query, input.colliders, particles_, input.seconds);
  time = lap(time, times_.broad);
  const double h = input.seconds / input.substeps;
  for (int substep = 0; substep < input.substeps; ++substep) {
    const double s = static_cast<double>(substep + 1) / input.substeps;
    integrate(input, h);
    follow_pins(input, s, h);
    time = lap(time, times_.cloth);
    contacts_.respond(query, s, pinned_, particles_);
    time = lap(time, times_.contact);
    close_seams();
    const auto divergence = renew_forces(substep);
    time = lap(time, times_.cloth);
    if (divergence) return divergence;
  }
  return std::nullopt;
}

} // namespace tutu::cloth
