// The report's cloth: masses, springs, drag, gravity, semi-implicit Euler, then projection out of the colliders.
#pragma once

#include "cloth/contact_response.h"
#include "cloth/garment.h"
#include "cloth/particles.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tutu::cloth {

/// Everything outside the garment during one frame.
struct FrameInput {
  proxies::SweptColliders colliders;
  std::span<const Vec3> pins_start, pins_end; ///< targets in the order of Garment::pins, world, m
  double seconds = 1.0 / 60.0;
  int substeps = 5;                 ///< >= 1
  Vec3 gravity = {0.0, -9.81, 0.0}; ///< m/s2
  double extra_drag = 0.0;          ///< 1/s on top of the fabric's: settles a drape
};

/// A run that cannot be continued: the first bad spring, and the strongest force at that moment.
struct Divergence {
  int substep = 0;  ///< of the frame, from 0
  int particle = 0; ///< an end of the bad spring
  Vec3 position = Vec3::Zero();
  double stretch = 0.0; ///< length / rest length - 1 of the bad spring; NaN when its length is
  int strongest_particle = 0;
  double strongest_force = 0.0; ///< N
};

/// Milliseconds of one frame.
struct SolverTimes {
  double broad = 0.0, cloth = 0.0, contact = 0.0;
};

/// forces += those of all springs at `positions`: for spring (i, j), K (|d| - L) d/|d| on i with d = x_j - x_i, the
/// opposite on j. N. Returns the index of the first structural spring whose length is not within (1 +
/// k_diverged_stretch) of its rest length.
std::optional<int> add_spring_forces(const Garment& garment, std::span<const Vec3> positions, std::span<Vec3> forces);

/// Sum of K (|d| - L)^2 / 2 over all springs, J. The forces are its negative gradient.
double elastic_energy(const Garment& garment, std::span<const Vec3> positions);

/// One garment in motion. The garment must outlive it.
class MassSpring {
public:
  explicit MassSpring(const Garment& garment);

  /// At rest at these positions (world, one a particle).
  void reset(std::span<const Vec3> positions);

  /// One frame in `input.substeps` equal substeps h. In each, with forces at the positions it starts from:
  ///   v += h (F/m + g - drag v),  x += h v,  pins to their targets, collisions, seams, then forces and the check.
  /// On divergence the state is that of the substep in which it happened.
  std::optional<Divergence> step(const FrameInput& input, proxies::CollisionQuery& query);

  const Garment& garment() const { return *garment_; }
  const Particles& particles() const { return particles_; }
  const SolverTimes& times() const { return times_; } ///< of the last frame
  const ContactCounts& contact_counts() const { return contacts_.counts(); }

private:
  void integrate(const FrameInput& input, double h);
  void follow_pins(const FrameInput& input, double s, double h);
  void close_seams();
  std::optional<Divergence> renew_forces(int substep);

  const Garment* garment_;
  Particles particles_;
  std::vector<Vec3> forces_; ///< N, of the springs at the present positions
  std::vector<std::uint8_t> pinned_;
  ContactResponse contacts_;
  SolverTimes times_;
};

} // namespace tutu::cloth
