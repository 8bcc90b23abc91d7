// The report's cloth: masses, springs, drag, gravity, semi-implicit Euler, then projection out of the colliders.
#pragma once

#include "cloth/contact/triangle_contacts.h"
#include "cloth/solver.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tutu::cloth {

/// A substep h, with forces of springs and dampers at the positions and velocities it starts from:
///   v less what the air takes (cloth/air/air.h, where the fabric has it),
///   v += h (F/m + g - drag v),  x += h v,  pins to their targets, collisions, seams, then forces and the check.
/// Dampers are the fabric's as far as the step bears them: beside springs that vibrate at w and drag c, semi-implicit
/// Euler with dampers of time t stands while h^2 w^2 + 2 h (c + t w^2) < 4 [Jury's test, as in
/// src/study/stability/step_bound.h]; t is at most half of that, and nothing where springs alone are at their limit.
/// A collision puts the particle, or the point of a triangle, on the surface and cancels its normal velocity,
/// v -= (v . n) n, without friction [INF585 report 2021, collisions].
class MassSpring final : public Solver {
public:
  explicit MassSpring(const Garment& garment, const SolverOptions& options = {});

  void reset(std::span<const Vec3> positions) override;
  void restore(const Particles& state) override;
  std::optional<Unfinished> step(const FrameInput& input, proxies::CollisionQuery& query) override;
  const Particles& particles() const override { return particles_; }
  const SolverTimes& times() const override { return times_; }
  ContactCounts contact_counts() const override { return contacts_.counts() + triangle_contacts_.counts(); }
  BroadPhaseView broad_phase() const override { return contacts_.broad_phase(); }

private:
  void integrate(const FrameInput& input, double h);
  double damping(double drag, double h) const; ///< s, of dampers that a step of h s bears
  bool renew_forces();                         ///< false where a structural spring is broken

  const Garment* garment_;
  Particles particles_;
  double vibration_ = 0.0;   ///< rad/s, the fastest of the springs
  std::vector<Vec3> forces_; ///< N, of the springs at the present positions
  std::vector<std::uint8_t> pinned_;
  ContactSearch contacts_;
  TriangleContacts triangle_contacts_;
  SolverTimes times_;
};

} // namespace tutu::cloth
