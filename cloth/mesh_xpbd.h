// Extended position-based dynamics in small steps for cloth of any triangles.
#pragma once

#include "cloth/contact/triangle_contacts.h"
#include "cloth/garment/elements.h"
#include "cloth/solver.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tutu::cloth {

/// Takes any garment; for one woven in rows and columns there are faster solvers. Float or double is the precision in
/// which constraints are solved; what moves is kept in double, so that cloth on which nothing pulls falls exactly.
///
/// A substep h [Macklin et al. 2019, Small Steps in Physics Simulation, algorithm 1]:
///   v less what the air takes (cloth/air/air.h, where the fabric has it),
///   v += h g, v /= 1 + h drag,  x* = x + h v,  pins to their targets,  constraints,  seams,  contacts last,
///   v = (x - x_old) / h,  dampers.
/// Constraints, each with dlambda = (-C - a/h^2 lambda) / (sum w |grad C|^2 + a/h^2) [Macklin et al. 2016, XPBD, eq.
/// 18]:
///   stretch  C = |x_j - x_i| - L, a = 1/K, for structural and shear springs, pulling along the edge as it was at the
///            substep's start (cloth/damping.h)
///   bend     C = angle - rest angle, a = 1/k (garment_elements.h); bend springs do not count
///   tethers  C = |x - anchor| - length <= 0, rigid, after the others.
/// They are solved colour by colour (no two of a colour share a particle): stretch up the order of colours, bend,
/// stretch down again; in every second substep down first. That is not for speed. A pass in one direction answers like
/// a stiffness matrix that is not symmetric, and such a system gains energy by itself: a still sheet of 516 particles
/// and 5000 N/m stretched by 48 % in 16 substeps of one pass each, and by 147 % where the direction changed from
/// substep to substep; by 9 % in 8 substeps of both directions, at the same cost, and by 4.8 % with the order changing.
/// (At 16 substeps: 1.2 %, with a tremble of 0.15 mm from one substep to the next.) Chebyshev's acceleration and
/// multipliers kept from substep to substep were no help; the second made it diverge.
///
/// What the substep takes from a vibration by itself is like damping of time h (cloth/damping.h). Dampers take the rest
/// of the fabric's from the velocities, one after the other, each at most all of its rate: energy only falls, and what
/// moves or turns as a whole keeps its own. What is too stiff for the substep is left to it: there the passes do not
/// come to an end, and live on the motion that dampers would take.
///
/// Too few substeps leave cloth softer than its fabric, in stretch and in bend, and more so the finer it is: the
/// substeps that keep a cantilever within 10 % of its deflection rise with the square of its cells.
///
/// A contact is pushed out along its normal; the tangential motion relative to the moving surface is taken back by at
/// most friction * push (Coulomb, on positions).
template <class Scalar> class MeshXpbd final : public Solver {
public:
  explicit MeshXpbd(const Garment& garment, const SolverOptions& options = {});

  void reset(std::span<const Vec3> positions) override;
  void restore(const Particles& state) override;
  std::optional<Unfinished> step(const FrameInput& input, proxies::CollisionQuery& query) override;
  const Particles& particles() const override { return particles_; }
  const SolverTimes& times() const override { return times_; }
  ContactCounts contact_counts() const override { return contacts_.counts() + triangle_contacts_.counts(); }
  BroadPhaseView broad_phase() const override { return contacts_.broad_phase(); }

private:
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  struct Stretch {
    int i = 0, j = 0;
    Scalar rest_length = 0, compliance = 0; ///< m, m/N
    Scalar multiplier = 0;                  ///< N s2; 0 at the start of a substep
  };
  struct Hinge {
    int a = 0, b = 0, c = 0, d = 0;
    Scalar rest_angle = 0, compliance = 0; ///< rad, 1/(N m)
  };
  struct TetherLimit {
    int particle = 0, anchor = 0;
    Scalar length = 0; ///< m
  };

  template <std::size_t count> struct Damper {
    std::array<int, count> particles;
    /// Of what is damped: halfway through the substep, where it does not change as the cloth turns, and at the end,
    /// along which it is pulled, which leaves angular momentum.
    std::array<Vec3, count> gradient, along;
    double elastic = 0.0; ///< stiffness times h^2
  };

  void add_stretches();
  void add_hinges();
  void add_tethers();
  void predict(const FrameInput& input, double s, double h);
  void solve(Stretch& stretch, Scalar per_h2); ///< 1/s2
  void solve(const Hinge& hinge, Scalar per_h2);
  void solve(const TetherLimit& tether);
  void solve_constraints(double h, bool up_first);
  void damp(double h, bool up_first);
  template <std::size_t count> void damp(const Damper<count>& damper, double time_per_h);
  bool is_broken() const; ///< an edge
  bool is_outrun() const; ///< by a pin that no particle may follow

  const Garment* garment_;
  Particles particles_;
  std::vector<Vec3> before_, halfway_; ///< positions at the substep's start, and halfway through it where it is damped
  std::vector<std::uint8_t> pinned_;
  std::vector<Scalar> inverse_masses_; ///< 1/kg, 0 for pinned particles
  std::vector<Stretch> stretches_;     ///< colour by colour
  std::vector<Hinge> hinges_;          ///< colour by colour
  std::vector<TetherLimit> tethers_;
  std::vector<Vector> x_, was_, predicted_; ///< from a particle of the garment: being solved, at the substep's start,
                                            ///< and before the constraints
  Scalar longest_edge_ = 0;                 ///< over its length at rest: k_longest_edge, but where a pin outruns all
  ContactSearch contacts_;
  TriangleContacts triangle_contacts_;
  SolverTimes times_;
};

extern template class MeshXpbd<float>;
extern template class MeshXpbd<double>;

} // namespace tutu::cloth
