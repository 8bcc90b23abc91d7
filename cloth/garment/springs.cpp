#include "cloth/garment/springs.h"

#include "cloth/state/tolerances.h"

namespace tutu::cloth {

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

void add_damping_forces(const Garment& garment, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                        double time, std::span<Vec3> forces) {
  for (const Spring& spring : garment.springs) {
    const Vec3 d = positions[spring.j] - positions[spring.i];
    const double squared = d.squaredNorm();
    if (!(squared > 0.0)) continue; // two particles in one place: no direction, no force
    const double rate = (velocities[spring.j] - velocities[spring.i]).dot(d); // of d^2 / 2
    const Vec3 force = (spring.stiffness * time * rate / squared) * d;
    forces[spring.i] += force;
    forces[spring.j] -= force;
  }
}

double elastic_energy(const Garment& garment, std::span<const Vec3> positions) {
  double energy = 0.0;
  for (const Spring& spring : garment.springs) {
    const double extension = (positions[spring.j] - positions[spring.i]).norm() - spring.rest_length;
    energy += 0.5 * spring.stiffness * extension * extension;
  }
  return energy;
}

} // namespace tutu::cloth
