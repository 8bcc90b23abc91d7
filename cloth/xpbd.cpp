#include "cloth/xpbd.h"

#include "cloth/solver_parts.h"

#include <algorithm>
#include <cmath>

namespace tutu::cloth {

Xpbd::Xpbd(const Garment& garment)
    : garment_(&garment), pinned_(pinned_flags(garment)), contacts_(garment.fabric.contact_offset()) {
  for (int i = 0; i < garment.particle_count(); ++i)
    inverse_masses_.push_back(pinned_[i] ? 0.0 : 1.0 / garment.masses[i]);

  // Warp runs down the columns; its spring from (row, column) to the row below is known by its two ends.
  for (int column = 0; column < garment.columns; ++column) {
    Thread thread;
    for (int row = 0; row < garment.rows; ++row) thread.particles.push_back(row * garment.columns + column);
    thread.springs.resize(garment.rows - 1);
    threads_.push_back(thread);
  }
  for (const Spring& spring : garment.springs) compliances_.push_back(1.0 / spring.stiffness);
  std::vector<int> weft;
  for (int k = 0; k < static_cast<int>(garment.springs.size()); ++k) {
    const Spring& spring = garment.springs[k];
    if (k >= garment.structural_count) loose_springs_.push_back(k);
    else if (spring.j == spring.i + garment.columns)
      threads_[spring.i % garment.columns].springs[spring.i / garment.columns] = k;
    else weft.push_back(k);
  }
  loose_springs_.insert(loose_springs_.end(), weft.begin(), weft.end());
  multipliers_.resize(garment.springs.size());
  rows_.resize(garment.rows);
  reset(garment.rest_positions);
}

void Xpbd::reset(std::span<const Vec3> positions) {
  particles_.positions.assign(positions.begin(), positions.end());
  particles_.velocities.assign(positions.size(), Vec3::Zero());
  before_ = particles_.positions;
}

void Xpbd::predict(const FrameInput& input, double s, double h) {
  const double kept = 1.0 / (1.0 + h * (garment_->fabric.drag + input.extra_drag));
  before_ = particles_.positions;
  for (int i = 0; i < particles_.count(); ++i) {
    if (pinned_[i]) continue;
    particles_.velocities[i] = kept * (particles_.velocities[i] + h * input.gravity);
    particles_.positions[i] += h * particles_.velocities[i];
  }
  follow_pins(*garment_, input, s, h, particles_);
}

void Xpbd::solve_spring(int spring, double per_h2) {
  const Spring& s = garment_->springs[spring];
  const double wi = inverse_masses_[s.i], wj = inverse_masses_[s.j];
  const Vec3 d = particles_.positions[s.j] - particles_.positions[s.i];
  const double length = d.norm();
  if (wi + wj == 0.0 || !(length > 0.0)) return;
  const double compliance = compliances_[spring] * per_h2;
  double& lambda = multipliers_[spring];
  const double step = (s.rest_length - length - compliance * lambda) / (wi + wj + compliance);
  lambda += step;
  const Vec3 pull = (step / length) * d;
  particles_.positions[s.i] -= wi * pull;
  particles_.positions[s.j] += wj * pull;
}

void Xpbd::solve_thread(const Thread& thread, double per_h2) {
  // One Newton step of (J M^-1 J^T + a/h^2) dlambda = -C - a/h^2 lambda over the thread: tridiagonal, since an edge
  // shares a particle with the next one only. Forward elimination, then back substitution and the particles' moves.
  const int edges = static_cast<int>(thread.springs.size());
  for (int k = 0; k < edges; ++k) {
    const Spring& spring = garment_->springs[thread.springs[k]];
    const double w_above = inverse_masses_[spring.i], w_below = inverse_masses_[spring.j];
    const Vec3 d = particles_.positions[spring.j] - particles_.positions[spring.i];
    const double length = d.norm();
    Row& row = rows_[k];
    row.direction = length > 0.0 ? Vec3((1.0 / length) * d) : Vec3(Vec3::Zero());
    const double compliance = compliances_[thread.springs[k]] * per_h2;
    const double residual = spring.rest_length - length - compliance * multipliers_[thread.springs[k]];
    const double diagonal = w_above + w_below + compliance;
    if (k == 0) {
      row.m = 1.0 / diagonal;
      row.d = residual * row.m;
    } else {
      const double coupling = -w_above * row.direction.dot(rows_[k - 1].direction);
      row.m = 1.0 / (diagonal - coupling * coupling * rows_[k - 1].m);
      row.d = (residual - coupling * rows_[k - 1].d) * row.m;
    }
  }
  double below = 0.0; // the multiplier's step of the edge below
  for (int k = edges - 1; k >= 0; --k) {
    const int lower = thread.particles[k + 1];
    const double w = inverse_masses_[lower];
    const double coupling = k + 1 < edges ? -w * rows_[k + 1].direction.dot(rows_[k].direction) : 0.0;
    const double step = rows_[k].d - coupling * rows_[k].m * below;
    multipliers_[thread.springs[k]] += step;
    particles_.positions[lower] += (w * step) * rows_[k].direction;
    particles_.positions[thread.particles[k]] -= (inverse_masses_[thread.particles[k]] * step) * rows_[k].direction;
    below = step;
  }
}

void Xpbd::solve_constraints(double h) {
  const double per_h2 = 1.0 / (h * h);
  std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
  for (const int spring : loose_springs_) solve_spring(spring, per_h2);
  close_seams(*garment_, pinned_, particles_); // both sides start the threads together, so that neither is torn off
  constexpr int k_newton_steps = 2;
  for (const Thread& thread : threads_) {
    for (int k = 0; k < k_newton_steps; ++k) solve_thread(thread, per_h2);
    for (const int spring : thread.springs) solve_spring(spring, per_h2);
  }
}

std::optional<Divergence> Xpbd::check(int substep) {
  for (int k = 0; k < garment_->structural_count; ++k) {
    const Spring& spring = garment_->springs[k];
    const double length = (particles_.positions[spring.j] - particles_.positions[spring.i]).norm();
    if (length <= (1.0 + k_diverged_stretch) * spring.rest_length) continue; // false for a length that is no number
    return find_divergence(*garment_, substep, particles_.positions);
  }
  return std::nullopt;
}

std::optional<Divergence> Xpbd::step(const FrameInput& input, proxies::CollisionQuery& query) {
  times_ = {};
  auto time = Clock::now();
  contacts_.begin_frame(query, input.colliders, particles_, input.seconds);
  time = lap(time, times_.broad);
  const double h = input.seconds / input.substeps;
  const auto rub = [&](int i, int collider, const proxies::Contact& contact, double push) {
    Vec3& x = particles_.positions[i];
    x += push * contact.normal;
    if (input.friction.empty()) return;
    const Vec3 slip = x - before_[i] - contacts_.surface_motion(collider, x);
    const Vec3 along = slip - slip.dot(contact.normal) * contact.normal;
    const double length = along.norm(), most = input.friction[collider] * push;
    x -= length > most ? Vec3((most / length) * along) : along;
  };
  for (int substep = 0; substep < input.substeps; ++substep) {
    predict(input, static_cast<double>(substep + 1) / input.substeps, h);
    solve_constraints(h);
    close_seams(*garment_, pinned_, particles_);
    time = lap(time, times_.cloth);
    if (!is_in_world(particles_)) return find_divergence(*garment_, substep, particles_.positions);
    contacts_.for_each_contact(query, static_cast<double>(substep + 1) / input.substeps, pinned_, particles_, rub);
    time = lap(time, times_.contact);
    for (int i = 0; i < particles_.count(); ++i)
      if (!pinned_[i]) particles_.velocities[i] = (particles_.positions[i] - before_[i]) / h;
    auto divergence = check(substep);
    time = lap(time, times_.cloth);
    if (divergence) return divergence;
  }
  return std::nullopt;
}

} // namespace tutu::cloth
