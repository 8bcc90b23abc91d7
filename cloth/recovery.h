// Bad frames are taken back and taken again: a run goes on where a bare solver would have to stop.
#pragma once

#include "cloth/solver.h"
#include "cloth/state/tolerances.h"

#include <memory>
#include <optional>

namespace tutu::cloth {

/// How a frame that diverged was carried after all, or that it was not.
struct Recovery {
  Divergence divergence;  ///< of the first try
  int first_substeps = 0; ///< substeps a frame of that try; what divergence.substep counts in
  int tries = 0;          ///< that followed it
  int substeps = 0;       ///< a frame, of the last try
  bool at_rest = false;   ///< the last try took the frame for a jump: no velocities, edges drawn in
  bool carried = false;   ///< the last try held, and the run goes on
  bool worn_out = false;  ///< it held, and is the last of k_stops_in_a_row frames that only a jump carried
};

/// Moves free particles until no structural edge is longer than (1 + k_mended_stretch) of its rest length, in at most
/// k_mending_passes passes of Gauss-Seidel, heavier ends giving way less. Colliders are not asked. Positions that are
/// no numbers stay so.
/// Ends early, with a whole pass, when `input` says stop.
void draw_in_edges(const Garment& garment, std::span<Vec3> positions, const FrameInput& input = {});

/// A solver with a way back. step() keeps the state at the frame's start; when the solver diverges, that state comes
/// back and the same frame is taken with twice the substeps, up to k_recovery_tries doublings or
/// k_most_recovery_substeps. One more try takes the frame for a jump: particles are carried along with the mean way of
/// their pins, stand still where colliders and pins are at the frame's end, and overlong edges are drawn in. A state
/// that is itself wild (thrown together, or let grow just below the bound of divergence for some frames) and a body
/// that is suddenly elsewhere are not cured by small steps. When no try holds, or k_stops_in_a_row frames in a row were
/// carried by the last one only, step() returns the first divergence, and the state is that of the frame's start.
///
/// Pins or colliders that are no numbers fail the frame at once. A frame that is told to stop was not taken: the state
/// is that of its start, and recovery() has nothing to tell.
///
/// After a recovery the next frames begin with the substeps that carried it; every k_calm_frames good frames halve them
/// until they are what is asked for. All of it depends on the run so far only: same input, same bits.
///
/// Memory is allocated once, except for mending and for finding out what went wrong.
class GuardedSolver final : public Solver {
public:
  /// The garment is the solver's, and must outlive it.
  GuardedSolver(std::unique_ptr<Solver> solver, const Garment& garment)
      : solver_(std::move(solver)), garment_(&garment) {}

  void reset(std::span<const Vec3> positions) override;
  void restore(const Particles& state) override;
  std::optional<Unfinished> step(const FrameInput& input, proxies::CollisionQuery& query) override;
  const Particles& particles() const override { return solver_->particles(); }
  const SolverTimes& times() const override { return times_; } ///< of all tries of the last frame
  ContactCounts contact_counts() const override { return solver_->contact_counts(); }
  BroadPhaseView broad_phase() const override { return solver_->broad_phase(); }
  SelfCollisionCounts self_collision_counts() const override { return solver_->self_collision_counts(); }

  /// What happened in the last frame; nothing when it held at once.
  const std::optional<Recovery>& recovery() const { return recovery_; }
  /// Substeps a frame in the last frame's last try.
  int substeps() const { return substeps_; }

private:
  std::optional<Unfinished> attempt(FrameInput input, proxies::CollisionQuery& query);
  void jump(FrameInput& input);
  Divergence nowhere(const FrameInput& input) const;
  void forget();

  std::unique_ptr<Solver> solver_;
  const Garment* garment_;
  Particles good_; ///< at the frame's start
  std::vector<Vec3> mended_;
  SolverTimes times_;
  std::optional<Recovery> recovery_;
  int refinement_ = 1; ///< times the asked substeps, for the next frame
  int calm_ = 0;       ///< good frames since refinement_ last changed
  int stops_ = 0;      ///< frames in a row that were carried from rest
  int substeps_ = 0;
};

} // namespace tutu::cloth
