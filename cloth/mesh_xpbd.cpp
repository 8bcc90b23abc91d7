#include "cloth/mesh_xpbd.h"

#include "cloth/detail/colouring.h"
#include "cloth/detail/solver_parts.h"
#include "cloth/garment/dihedral.h"
#include "cloth/state/tolerances.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tutu::cloth {
namespace {

/// Of its length at rest. An edge that is longer is torn by a blow or left so by the passes: that is no strain, and a
/// damper would hold back the cloth that follows it. A limb of 12 mm at 20 m/s then slips through.
constexpr double k_most_damped = 1.25;

} // namespace

template <class Scalar>
MeshXpbd<Scalar>::MeshXpbd(const Garment& garment, const SolverOptions& options)
    : garment_(&garment), pinned_(pinned_flags(garment)), x_(garment.rest_positions.size()),
      was_(garment.rest_positions.size()), predicted_(garment.rest_positions.size()), contacts_(garment, options.swept),
      triangle_contacts_(garment, options) {
  for (int i = 0; i < garment.particle_count(); ++i)
    inverse_masses_.push_back(pinned_[i] ? Scalar(0) : static_cast<Scalar>(1.0 / garment.masses[i]));
  add_stretches();
  add_hinges();
  add_tethers();
  reset(garment.rest_positions);
}

template <class Scalar> void MeshXpbd<Scalar>::add_stretches() {
  std::vector<const Spring*> springs;
  std::vector<int> ends;
  for (const Spring& spring : garment_->springs) {
    if (spring.kind == SpringKind::bend || (pinned_[spring.i] && pinned_[spring.j])) continue;
    springs.push_back(&spring);
    ends.insert(ends.end(), {spring.i, spring.j});
  }
  for (const int e : colour(ends, 2, garment_->particle_count()).order)
    stretches_.push_back({springs[e]->i, springs[e]->j, static_cast<Scalar>(springs[e]->rest_length),
                          static_cast<Scalar>(1.0 / springs[e]->stiffness)});
}

template <class Scalar> void MeshXpbd<Scalar>::add_hinges() {
  std::vector<Bend> bends = build_bends(*garment_);
  std::erase_if(bends, [&](const Bend& b) { return pinned_[b.a] && pinned_[b.b] && pinned_[b.c] && pinned_[b.d]; });
  std::vector<int> corners;
  for (const Bend& bend : bends) corners.insert(corners.end(), {bend.a, bend.b, bend.c, bend.d});
  for (const int e : colour(corners, 4, garment_->particle_count()).order)
    hinges_.push_back({bends[e].a, bends[e].b, bends[e].c, bends[e].d, static_cast<Scalar>(bends[e].rest_angle),
                       static_cast<Scalar>(1.0 / bends[e].stiffness)});
}

template <class Scalar> void MeshXpbd<Scalar>::add_tethers() {
  for (const Tether& tether : build_tethers(*garment_))
    tethers_.push_back({tether.particle, tether.anchor, static_cast<Scalar>(longest_of(tether, garment_->fabric))});
}

template <class Scalar> void MeshXpbd<Scalar>::reset(std::span<const Vec3> positions) {
  particles_.positions.assign(positions.begin(), positions.end());
  particles_.velocities.assign(positions.size(), Vec3::Zero());
  before_ = particles_.positions;
  halfway_.resize(positions.size());
}

template <class Scalar> void MeshXpbd<Scalar>::restore(const Particles& state) {
  particles_ = state;
  before_ = state.positions;
  contacts_.forget();
}

template <class Scalar> void MeshXpbd<Scalar>::predict(const FrameInput& input, double s, double h) {
  const double kept = 1.0 / (1.0 + h * (garment_->fabric.drag + input.extra_drag));
  before_ = particles_.positions;
  meet_air(*garment_, pinned_, input, s, h, particles_);
  for (int i = 0; i < particles_.count(); ++i) {
    if (pinned_[i]) continue;
    particles_.velocities[i] = kept * (particles_.velocities[i] + h * input.gravity);
    particles_.positions[i] += h * particles_.velocities[i];
  }
  follow_pins(*garment_, input, s, h, particles_);
}

template <class Scalar> void MeshXpbd<Scalar>::solve(Stretch& stretch, Scalar per_h2) {
  const Scalar wi = inverse_masses_[stretch.i], wj = inverse_masses_[stretch.j];
  const Vector d = x_[stretch.j] - x_[stretch.i];
  const Scalar length = d.norm();
  if (!(length > 0)) return; // two particles in one place: no direction
  const Scalar compliance = stretch.compliance * per_h2;
  const Scalar elastic = (stretch.rest_length - length - compliance * stretch.multiplier) / (wi + wj + compliance);
  const Scalar step = std::min(elastic, (longest_edge_ * stretch.rest_length - length) / (wi + wj));
  stretch.multiplier += step;
  const Vector was = was_[stretch.j] - was_[stretch.i];
  const Scalar share = step / length;
  const bool as_it_was = std::abs(d.dot(d - was)) <= static_cast<Scalar>(k_most_turn) * length * length &&
                         std::abs(stretch.multiplier) * (wi + wj) <= static_cast<Scalar>(k_most_pull) * length;
  const Vector pull = share * (as_it_was ? was : d);
  x_[stretch.i] -= wi * pull;
  x_[stretch.j] += wj * pull;
}

template <class Scalar> void MeshXpbd<Scalar>::solve(const Hinge& hinge, Scalar per_h2) {
  const auto bent = dihedral<Scalar>(x_[hinge.a], x_[hinge.b], x_[hinge.c], x_[hinge.d]);
  const Scalar wa = inverse_masses_[hinge.a], wb = inverse_masses_[hinge.b];
  const Scalar wc = inverse_masses_[hinge.c], wd = inverse_masses_[hinge.d];
  const Scalar give = wa * bent.at_a.squaredNorm() + wb * bent.at_b.squaredNorm() + wc * bent.at_c.squaredNorm() +
                      wd * bent.at_d.squaredNorm();
  const Scalar step =
      (hinge.rest_angle - bent.angle()) / (give + hinge.compliance * per_h2); // once a substep: lambda 0
  x_[hinge.a] += (wa * step) * bent.at_a;
  x_[hinge.b] += (wb * step) * bent.at_b;
  x_[hinge.c] += (wc * step) * bent.at_c;
  x_[hinge.d] += (wd * step) * bent.at_d;
}

template <class Scalar> void MeshXpbd<Scalar>::solve(const TetherLimit& tether) {
  const Vector d = x_[tether.particle] - x_[tether.anchor];
  const Scalar length = d.norm();
  if (length > tether.length) x_[tether.particle] -= (1 - tether.length / length) * d;
}

template <class Scalar> void MeshXpbd<Scalar>::solve_constraints(double h, bool up_first) {
  // From the garment itself rather than from the world's origin: floats are finest near 0. What comes back is the
  // constraints' displacement, so that rounding touches nothing else.
  const Vec3 origin = particles_.positions.front();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = (particles_.positions[i] - origin).template cast<Scalar>();
    was_[i] = (before_[i] - origin).template cast<Scalar>();
  }
  predicted_ = x_;

  const auto per_h2 = static_cast<Scalar>(1.0 / (h * h));
  for (Stretch& stretch : stretches_) stretch.multiplier = 0;
  const auto up = [&] {
    for (Stretch& stretch : stretches_) solve(stretch, per_h2);
  };
  const auto down = [&] {
    for (auto stretch = stretches_.rbegin(); stretch != stretches_.rend(); ++stretch) solve(*stretch, per_h2);
  };
  if (up_first) up();
  else down();
  for (const Hinge& hinge : hinges_) solve(hinge, per_h2);
  if (up_first) down();
  else up();
  for (const TetherLimit& tether : tethers_) solve(tether);

  for (std::size_t i = 0; i < x_.size(); ++i)
    if (!pinned_[i]) particles_.positions[i] += (x_[i] - predicted_[i]).template cast<double>();
}

template <class Scalar>
template <std::size_t count>
void MeshXpbd<Scalar>::damp(const Damper<count>& damper, double time_per_h) {
  std::vector<Vec3>& v = particles_.velocities;
  double rate = 0.0, give = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    rate += damper.gradient[k].dot(v[damper.particles[k]]);
    give += inverse_masses_[damper.particles[k]] * damper.gradient[k].dot(damper.along[k]);
  }
  if (!(give > 0.0)) return;
  const double w2 = damper.elastic * give, w4 = w2 * w2;                 // powers of w h, w of its own vibration
  const double strength = time_per_h * damper.elastic / (1.0 + w4 * w4); // a low-pass filter of order 4
  const double impulse = std::min(strength, 1.0 / give) * rate;
  for (std::size_t k = 0; k < count; ++k)
    v[damper.particles[k]] -= inverse_masses_[damper.particles[k]] * impulse * damper.along[k];
}

template <class Scalar> void MeshXpbd<Scalar>::damp(double h, bool up_first) {
  const double left = garment_->fabric.damping / h - 1.0;
  if (left <= 0.0) return;
  const std::vector<Vec3>& x = particles_.positions;
  for (std::size_t i = 0; i < halfway_.size(); ++i) halfway_[i] = 0.5 * (x[i] + before_[i]);
  for (const Hinge& hinge : hinges_) {
    const auto bent = dihedral<double>(halfway_[hinge.a], halfway_[hinge.b], halfway_[hinge.c], halfway_[hinge.d]);
    const std::array<Vec3, 4> gradient = {bent.at_a, bent.at_b, bent.at_c, bent.at_d};
    damp<4>({{hinge.a, hinge.b, hinge.c, hinge.d}, gradient, gradient, h * h / hinge.compliance}, left);
  }
  const auto damp_stretch = [&](const Stretch& stretch) {
    const Vec3 d = x[stretch.j] - x[stretch.i];
    if (d.norm() > k_most_damped * stretch.rest_length) return;
    const Vec3 was = (halfway_[stretch.j] - halfway_[stretch.i]).normalized(), is = d.normalized();
    damp<2>({{stretch.i, stretch.j}, {-was, was}, {-is, is}, h * h / stretch.compliance}, left);
  };
  if (up_first) std::for_each(stretches_.begin(), stretches_.end(), damp_stretch);
  else std::for_each(stretches_.rbegin(), stretches_.rend(), damp_stretch);
}

template <class Scalar> bool MeshXpbd<Scalar>::is_broken() const {
  for (int k = 0; k < garment_->structural_count; ++k) {
    const Spring& spring = garment_->springs[k];
    const double length = (particles_.positions[spring.j] - particles_.positions[spring.i]).norm();
    if (!(length <= (1.0 + k_diverged_stretch) * spring.rest_length)) return true; // so is one that is no number
  }
  return false;
}

template <class Scalar> bool MeshXpbd<Scalar>::is_outrun() const {
  return std::ranges::any_of(garment_->pins, [&](const Pin& pin) {
    return particles_.velocities[pin.particle].squaredNorm() > k_fastest_particle * k_fastest_particle;
  });
}

template <class Scalar>
std::optional<Unfinished> MeshXpbd<Scalar>::step(const FrameInput& input, proxies::CollisionQuery& query) {
  times_ = {};
  if (const auto unusable = find_unusable(*garment_, pinned_, particles_)) return *unusable;
  auto time = Clock::now();
  contacts_.begin_frame(query, input, particles_);
  triangle_contacts_.begin_frame(query, contacts_, particles_);
  time = lap(time, times_.broad);
  const double h = input.seconds / input.substeps;
  const auto rub = [&](int i, int collider, const proxies::Contact& contact, double push) {
    std::vector<Vec3>& x = particles_.positions;
    const Vec3 moved = contacts_.fitted(i, contacts_.way_out(x[i], before_[i], collider, contact, push), x);
    x[i] += moved;
    return Response{moved, moved / h};
  };
  const auto settle = [&](int i, const BetweenColliders::Settled& settled) {
    particles_.positions[i] += settled.way;
    before_[i] += settled.start;
    return Response{settled.way, (settled.way - settled.start) / h};
  };
  const auto rub_triangle = [&](const ClothContact& contact) {
    const Vec3 moved = push_out(contact, contacts_, before_, particles_.positions);
    return Response{moved, moved / h};
  };
  for (int substep = 0; substep < input.substeps; ++substep) {
    if (input.is_stopped()) return Stopped{substep};
    const double s = static_cast<double>(substep + 1) / input.substeps;
    const Moment now{*garment_, pinned_, substep, h, particles_, before_};
    predict(input, s, h);
    longest_edge_ = is_outrun() ? std::numeric_limits<Scalar>::max() : static_cast<Scalar>(k_longest_edge);
    solve_constraints(h, substep % 2 == 0);
    close_seams(*garment_, pinned_, particles_);
    time = lap(time, times_.cloth);
    if (!is_in_world(particles_)) return find_trouble(now, {});
    contacts_.for_each_contact(query, s, pinned_, particles_, rub, settle);
    triangle_contacts_.for_each_contact(query, contacts_, particles_, rub_triangle);
    time = lap(time, times_.contact);
    for (int i = 0; i < particles_.count(); ++i) {
      if (pinned_[i]) continue;
      Vec3& v = particles_.velocities[i];
      v = (particles_.positions[i] - before_[i]) / h;
      if (const double speed = v.norm(); speed > k_fastest_particle) v *= k_fastest_particle / speed;
    }
    damp(h, substep % 2 == 0);
    const bool broken = is_broken();
    time = lap(time, times_.cloth);
    if (broken) return find_trouble(now, {});
  }
  return std::nullopt;
}

template class MeshXpbd<float>;
template class MeshXpbd<double>;

} // namespace tutu::cloth
