#include "cloth/detail/solver_parts.h"

#include "cloth/garment/springs.h"
#include "cloth/state/tolerances.h"

#include <cmath>

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

Divergence find_divergence(const Garment& garment, int substep, std::span<const Vec3> positions) {
  std::vector<Vec3> forces(positions.size(), Vec3::Zero());
  const std::optional<int> bad = add_spring_forces(garment, positions, forces);
  Divergence divergence = describe_divergence(garment, bad.value_or(0), substep, positions, forces);
  for (std::size_t i = 0; !bad && i < positions.size(); ++i) {
    if (is_in_world(positions[i])) continue;
    divergence.particle = static_cast<int>(i);
    divergence.position = positions[i];
    break;
  }
  return divergence;
}

Divergence describe_divergence(const Garment& garment, int bad_spring, int substep, std::span<const Vec3> positions,
                               std::span<const Vec3> forces) {
  const Spring& spring = garment.springs[bad_spring];
  Divergence divergence;
  divergence.substep = substep;
  divergence.particle = spring.j;
  divergence.position = positions[spring.j];
  divergence.stretch = (positions[spring.j] - positions[spring.i]).norm() / spring.rest_length - 1.0;
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (const double force = forces[i].norm(); !(force <= divergence.strongest_force)) {
      divergence.strongest_force = force;
      divergence.strongest_particle = static_cast<int>(i);
      if (std::isnan(force)) break;
    }
  return divergence;
}

} // namespace tutu::cloth
