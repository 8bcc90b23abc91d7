// Extended position-based dynamics in small steps, with whole warp threads solved at once.
#pragma once

#include "cloth/contact_search.h"
#include "cloth/solver.h"

#include <vector>

namespace tutu::cloth {

/// Double precision, one thread, plain: what faster kernels are to be compared with.
///
/// A substep h [Macklin et al. 2019, Small Steps in Physics Simulation, algorithm 1]:
///   v += h g, v /= 1 + h drag,  x* = x + h v,  pins to their targets,  one pass over the constraints,  seams,
///   contacts last,  v = (x - x_old) / h.
/// A constraint C = |x_j - x_i| - L of compliance a = 1 / K takes part with
///   dlambda = (-C - a/h^2 lambda) / (w_i + w_j + a/h^2)  [Macklin et al. 2016, XPBD, eq. 18].
/// Order: shear, bend, weft by Gauss-Seidel; then each warp thread as a whole (twice: the second step is Newton's
/// answer to the first one's linearisation), then once more by Gauss-Seidel.
///
/// A contact is pushed out along its normal; the tangential motion relative to the moving surface is taken back by at
/// most friction * push (Coulomb, on positions).
class Xpbd final : public Solver {
public:
  explicit Xpbd(const Garment& garment);

  void reset(std::span<const Vec3> positions) override;
  std::optional<Divergence> step(const FrameInput& input, proxies::CollisionQuery& query) override;
  const Particles& particles() const override { return particles_; }
  const SolverTimes& times() const override { return times_; }
  const ContactCounts& contact_counts() const override { return contacts_.counts(); }

private:
  /// A warp thread: particles from one border to the other, and the springs between them.
  struct Thread {
    std::vector<int> particles; ///< n
    std::vector<int> springs;   ///< n - 1; springs[k] joins particles[k] and particles[k + 1]
  };

  void predict(const FrameInput& input, double s, double h);
  void solve_spring(int spring, double per_h2); ///< 1/s2
  void solve_thread(const Thread& thread, double per_h2);
  void solve_constraints(double h);
  std::optional<Divergence> check(int substep);

  const Garment* garment_;
  Particles particles_;
  std::vector<Vec3> before_;           ///< positions at the substep's start
  std::vector<double> inverse_masses_; ///< 1/kg, 0 for pinned particles
  std::vector<std::uint8_t> pinned_;
  std::vector<Thread> threads_;
  std::vector<int> loose_springs_;  ///< all that are in no thread: shear, bend, weft
  std::vector<double> compliances_; ///< one a spring, m/N
  std::vector<double> multipliers_; ///< one a spring, N s2; 0 at the start of a substep
  struct Row {
    Vec3 direction = Vec3::Zero(); ///< of the edge
    double m = 0.0, d = 0.0;       ///< of the elimination
  };
  std::vector<Row> rows_; ///< working memory of solve_thread
  ContactSearch contacts_;
  SolverTimes times_;
};

} // namespace tutu::cloth
