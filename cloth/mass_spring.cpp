#include "cloth/mass_spring.h"

#include "cloth/detail/solver_parts.h"
#include "cloth/garment/springs.h"
#include "cloth/garment/vibration.h"

#include <algorithm>

namespace tutu::cloth {

MassSpring::MassSpring(const Garment& garment, const SolverOptions& options)
    : garment_(&garment), vibration_(fastest_vibration(garment)), pinned_(pinned_flags(garment)),
      contacts_(garment, options.swept), triangle_contacts_(garment, options) {
  reset(garment.rest_positions);
}

void MassSpring::reset(std::span<const Vec3> positions) {
  particles_.positions.assign(positions.begin(), positions.end());
  particles_.velocities.assign(positions.size(), Vec3::Zero());
  forces_.assign(positions.size(), Vec3::Zero());
  renew_forces();
}

void MassSpring::restore(const Particles& state) {
  particles_ = state;
  contacts_.forget();
  renew_forces();
}

double MassSpring::damping(double drag, double h) const {
  const double w2 = vibration_ * vibration_;
  if (!(w2 > 0.0)) return 0.0;
  const double borne = ((4.0 - h * h * w2) / (2.0 * h) - drag) / w2;
  return std::clamp(0.5 * borne, 0.0, garment_->fabric.damping);
}

void MassSpring::integrate(const FrameInput& input, double h) {
  const double drag = garment_->fabric.drag + input.extra_drag;
  if (const double time = damping(drag, h); time > 0.0)
    add_damping_forces(*garment_, particles_.positions, particles_.velocities, time, forces_);
  for (int i = 0; i < particles_.count(); ++i) {
    if (pinned_[i]) continue;
    Vec3& v = particles_.velocities[i];
    v += h * (forces_[i] / garment_->masses[i] + input.gravity - drag * v);
    particles_.positions[i] += h * v;
  }
}

bool MassSpring::renew_forces() {
  std::fill(forces_.begin(), forces_.end(), Vec3::Zero());
  return !add_spring_forces(*garment_, particles_.positions, forces_).has_value();
}

std::optional<Unfinished> MassSpring::step(const FrameInput& input, proxies::CollisionQuery& query) {
  times_ = {};
  if (const auto unusable = find_unusable(*garment_, pinned_, particles_)) return *unusable;
  auto time = Clock::now();
  FrameInput frictionless = input;
  frictionless.friction = {};
  contacts_.begin_frame(query, frictionless, particles_);
  triangle_contacts_.begin_frame(query, contacts_, particles_);
  time = lap(time, times_.broad);
  const double h = input.seconds / input.substeps;
  const auto stop_at_surface = [this](int i, int, const proxies::Contact& contact, double push) {
    const Response response{contacts_.fitted(i, push * contact.normal, particles_.positions),
                            -particles_.velocities[i].dot(contact.normal) * contact.normal};
    particles_.positions[i] += response.moved;
    particles_.velocities[i] += response.velocity;
    return response;
  };
  const auto settle = [&](int i, const BetweenColliders::Settled& settled) {
    const Response response{settled.way, (settled.way - settled.start) / h};
    particles_.positions[i] += response.moved;
    particles_.velocities[i] += response.velocity;
    return response;
  };
  const auto stop_triangle = [this](const ClothContact& contact) {
    const Vec3& n = contact.contact.normal;
    const Response response{contact.push * n, -contact.point(particles_.velocities).dot(n) * n};
    contact.move(particles_.positions, response.moved);
    contact.move(particles_.velocities, response.velocity);
    return response;
  };
  for (int substep = 0; substep < input.substeps; ++substep) {
    if (input.is_stopped()) return Stopped{substep};
    const double s = static_cast<double>(substep + 1) / input.substeps;
    meet_air(*garment_, pinned_, input, s, h, particles_);
    integrate(input, h);
    follow_pins(*garment_, input, s, h, particles_);
    time = lap(time, times_.cloth);
    if (!is_in_world(particles_)) {
      std::vector<Vec3> starts = particles_.positions;
      for (std::size_t i = 0; i < starts.size(); ++i) starts[i] -= h * particles_.velocities[i];
      return find_trouble({*garment_, pinned_, substep, h, particles_, starts}, {});
    }
    contacts_.for_each_contact(query, s, pinned_, particles_, stop_at_surface, settle);
    triangle_contacts_.for_each_contact(query, contacts_, particles_, stop_triangle);
    time = lap(time, times_.contact);
    close_seams(*garment_, pinned_, particles_);
    const bool whole = renew_forces();
    time = lap(time, times_.cloth);
    if (!whole) return find_trouble({*garment_, pinned_, substep, h, particles_, {}, forces_}, {});
  }
  return std::nullopt;
}

} // namespace tutu::cloth
