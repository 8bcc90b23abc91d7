// What every solver does: one garment, one frame at a time.
#pragma once

#include "cloth/garment/garment.h"
#include "cloth/state/divergence.h"
#include "cloth/state/frame.h"
#include "cloth/state/particles.h"
#include "cloth/state/solver_options.h"
#include "proxies/query/collision_query.h"

#include <memory>
#include <optional>
#include <span>
#include <variant>

namespace tutu::cloth {

/// Why a frame is not whole.
using Unfinished = std::variant<Divergence, Stopped>;

/// The divergence of a step; null when there was none.
inline const Divergence* divergence_of(const std::optional<Unfinished>& end) {
  return end ? std::get_if<Divergence>(&*end) : nullptr;
}

/// One garment in motion. The garment must outlive it; its memory is allocated once.
class Solver {
public:
  virtual ~Solver() = default;

  /// At rest at these positions (world, one a particle).
  virtual void reset(std::span<const Vec3> positions) = 0;

  /// In motion as in `state`, which particles() gave earlier: how a bad frame is taken back.
  virtual void restore(const Particles& state) = 0;

  /// One frame in `input.substeps` equal substeps. Nothing when the frame is whole. On divergence the state is that in
  /// which the trouble was found, within the substep in which it happened; a frame that was stopped ends with a whole
  /// substep.
  virtual std::optional<Unfinished> step(const FrameInput& input, proxies::CollisionQuery& query) = 0;

  virtual const Particles& particles() const = 0;
  virtual const SolverTimes& times() const = 0; ///< of the last frame
  virtual ContactCounts contact_counts() const = 0;
  virtual BroadPhaseView broad_phase() const { return {}; } ///< good until the next step()
  virtual SelfCollisionCounts self_collision_counts() const { return {}; }
};

std::unique_ptr<Solver> make_solver(const Garment& garment, const SolverOptions& options);

/// The options as the solver makes use of them for this garment and with queries of this backend: what it does not know
/// is what it does without. mass_spring knows particles in double alone; meshes and discs know neither threads nor
/// self-collision; only contacts in closed form (`hybrid`) know more than particles.
SolverOptions honoured(SolverOptions options, const Garment& garment, proxies::Backend backend);

} // namespace tutu::cloth
