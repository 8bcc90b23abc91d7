#include "cloth/detail/solver_parts.h"

#include "cloth/air/air.h"
#include "cloth/garment/springs.h"
#include "cloth/state/tolerances.h"

#include <cmath>
#include <limits>

namespace tutu::cloth {

Clock::time_point lap(Clock::time_point from, double& sum) {
  const auto now = Clock::now();
  sum += std::chrono::duration<double, std::milli>(now - from).count();
  return now;
}

void follow_pins(const Garment& garment, const FrameInput& input, double s, double h, Particles& particles) {
  for (std::size_t k = 0; k < garment.pins.size(); ++k) {
    const int i = garment.pins[k].particle;
    const Vec3 target = (1.0 - s) * input.pins_start[k] + s * input.pins_end[k];
    particles.velocities[i] = (target - particles.positions[i]) / h;
    particles.positions[i] = target;
  }
}

void meet_air(const Garment& garment, std::span<const std::uint8_t> pinned, const FrameInput& input, double s, double h,
              Particles& particles) {
  if (garment.fabric.air)
    apply_air(garment, pinned, input.wind_at(s - h / input.seconds), h, particles.positions, particles.velocities);
}

double share_of_second(const Garment& garment, std::span<const std::uint8_t> pinned, const Seam& seam) {
  if (pinned[seam.i] != pinned[seam.j]) return pinned[seam.j] ? 1.0 : 0.0;
  return garment.masses[seam.j] / (garment.masses[seam.i] + garment.masses[seam.j]);
}

void close_seams(const Garment& garment, std::span<const std::uint8_t> pinned, Particles& particles) {
  for (const Seam& seam : garment.seams) {
    const double share = share_of_second(garment, pinned, seam);
    for (std::vector<Vec3>* field : {&particles.positions, &particles.velocities}) {
      Vec3 &a = (*field)[seam.i], &b = (*field)[seam.j];
      a = b = (1.0 - share) * a + share * b;
    }
  }
}

namespace {

/// A divergence at a particle, with what brought it about.
Divergence trouble_at(const Moment& moment, Trouble trouble, int particle) {
  const Garment& garment = moment.garment;
  const Particles& now = moment.particles;
  Divergence divergence;
  divergence.trouble = trouble;
  divergence.substep = moment.substep;
  divergence.particle = particle;
  divergence.position = now.positions[particle];
  if (!divergence.position.allFinite() && !moment.starts.empty()) divergence.position = moment.starts[particle];
  divergence.speed = now.velocities[particle].norm();

  double nearest = std::numeric_limits<double>::infinity(); // m2, at rest
  for (const Pin& pin : garment.pins) {
    const double squared = (garment.rest_positions[pin.particle] - garment.rest_positions[particle]).squaredNorm();
    if (squared >= nearest) continue;
    nearest = squared;
    // A pin has the velocity that took it to where it is.
    divergence.held = Divergence::Held{pin.particle, now.velocities[pin.particle].norm() * moment.h};
  }
  std::vector<Vec3> worked_out;
  if (moment.forces.empty()) {
    worked_out.assign(now.positions.size(), Vec3::Zero());
    add_spring_forces(garment, now.positions, worked_out);
  }
  const std::span<const Vec3> forces = moment.forces.empty() ? worked_out : moment.forces;
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (const double force = forces[i].norm(); std::isfinite(force) && force > divergence.strongest_force) {
      divergence.strongest_force = force;
      divergence.strongest_particle = static_cast<int>(i);
    }
  return divergence;
}

/// The particle with the largest of these values; none where none is above 0.
template <class Value> std::optional<int> worst_particle(const Moment& moment, const Value& value) {
  std::optional<int> worst;
  double most = 0.0;
  for (int i = 0; i < moment.particles.count(); ++i)
    if (const double v = value(i); v > most) {
      most = v;
      worst = i;
    }
  return worst;
}

/// How far beyond the world's radius a vector reaches along an axis; 0 within.
double beyond_world(const Vec3& v) { return is_in_world(v) ? 0.0 : v.cwiseAbs().maxCoeff(); }

} // namespace

std::optional<Divergence> find_lost(const Moment& moment) {
  const auto &x = moment.particles.positions, &v = moment.particles.velocities;
  const auto began = [&](int i) { return moment.starts.empty() ? Vec3(Vec3::Zero()) : moment.starts[i]; };
  const auto began_as_none = [&](int i) { return v[i].allFinite() && began(i).allFinite() ? 0.0 : 1.0; };
  if (const auto i = worst_particle(moment, began_as_none)) return trouble_at(moment, Trouble::no_number, *i);
  if (const auto i = worst_particle(moment, [&](int k) { return x[k].allFinite() ? 0.0 : 1.0; }))
    return trouble_at(moment, Trouble::no_number, *i);
  if (const auto i = worst_particle(moment, [&](int k) { return beyond_world(began(k)); })) {
    Divergence divergence = trouble_at(moment, Trouble::out_of_world, *i);
    if (is_in_world(x[*i])) divergence.position = began(*i); // pulled back in since, and others out in its place
    return divergence;
  }
  if (const auto i = worst_particle(moment, [&](int k) { return beyond_world(x[k]); }))
    return trouble_at(moment, Trouble::out_of_world, *i);
  if (const auto i = worst_particle(moment, [&](int k) { return beyond_world(v[k]); }))
    return trouble_at(moment, Trouble::too_fast, *i);
  return std::nullopt;
}

std::optional<Divergence> find_unusable(const Garment& garment, std::span<const std::uint8_t> pinned,
                                        const Particles& particles) {
  constexpr double k_farthest = 1e12; // m, m/s: what queries take
  const auto is_usable = [](const Vec3& v) { return v.cwiseAbs().maxCoeff() <= k_farthest && v.allFinite(); };
  bool usable = true;
  for (int i = 0; i < particles.count(); ++i)
    usable = usable && is_usable(particles.positions[i]) && is_usable(particles.velocities[i]);
  return usable ? std::nullopt : find_lost({garment, pinned, 0, 0.0, particles});
}

std::optional<Divergence> find_overlong(const Moment& moment, const WatchedEdges& watched) {
  const Garment& garment = moment.garment;
  const auto &x = moment.particles.positions, &v = moment.particles.velocities;
  struct Way {
    Trouble trouble = Trouble::long_edge;
    int from = -1, to = -1;
    double length = 0.0, longest = 0.0; ///< m
  } worst;
  double most = (1.0 + k_diverged_stretch) * (1.0 - watched.rounding);
  const auto measure = [&](Trouble trouble, int from, int to, double longest) {
    const double length = (x[to] - x[from]).norm();
    if (!(length > most * longest)) return;
    most = length / longest;
    worst = {trouble, from, to, length, longest};
  };
  for (const Spring& spring : garment.springs) {
    if (spring.kind == SpringKind::bend || (spring.kind == SpringKind::shear && !watched.shear)) continue;
    if (!watched.between_pins && moment.pinned[spring.i] && moment.pinned[spring.j]) continue;
    measure(Trouble::long_edge, spring.i, spring.j, spring.rest_length);
  }
  for (const Tether& tether : watched.tethers)
    if (tether.length > 0.0) // else a seam holds it
      measure(Trouble::long_tether, tether.particle, tether.anchor, longest_of(tether, garment.fabric));
  if (worst.from < 0) return std::nullopt;
  if (worst.trouble == Trouble::long_edge && v[worst.to].norm() >= v[worst.from].norm())
    std::swap(worst.from, worst.to);
  Divergence divergence = trouble_at(moment, worst.trouble, worst.from);
  divergence.other = worst.to;
  divergence.length = worst.length;
  divergence.rest_length = worst.longest;
  return divergence;
}

Divergence find_trouble(const Moment& moment, const WatchedEdges& watched, std::optional<double> speed) {
  if (const auto lost = find_lost(moment)) return *lost;
  if (const auto overlong = find_overlong(moment, watched)) return *overlong;
  const auto way_of = [&](int i) {
    const Vec3& x = moment.particles.positions[i];
    return moment.starts.empty() ? x.norm() : (x - moment.starts[i]).norm();
  };
  const int farthest = worst_particle(moment, way_of).value_or(0);
  Divergence divergence = trouble_at(moment, Trouble::too_fast, farthest);
  if (speed) divergence.speed = *speed;
  else if (!moment.starts.empty()) divergence.speed = way_of(farthest) / moment.h;
  return divergence;
}

} // namespace tutu::cloth
