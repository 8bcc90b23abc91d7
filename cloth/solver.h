// What every solver takes and gives: one garment, one frame at a time.
#pragma once

#include "cloth/garment.h"
#include "cloth/particles.h"
#include "proxies/collision_query.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace tutu::cloth {

/// Everything outside the garment during one frame.
struct FrameInput {
  proxies::SweptColliders colliders;
  /// Coulomb coefficient of each collider, then the ground, then the true body; empty: none anywhere.
  std::span<const double> friction;
  std::span<const Vec3> pins_start, pins_end; ///< targets in the order of Garment::pins, world, m
  double seconds = 1.0 / 60.0;
  int substeps = 5;                 ///< >= 1
  Vec3 gravity = {0.0, -9.81, 0.0}; ///< m/s2
  double extra_drag = 0.0;          ///< 1/s on top of the fabric's: settles a drape
};

/// A run that cannot be continued: the first bad edge, and the strongest force at that moment.
struct Divergence {
  int substep = 0;  ///< of the frame, from 0
  int particle = 0; ///< an end of the bad edge
  Vec3 position = Vec3::Zero();
  double stretch = 0.0; ///< length / rest length - 1 of the bad edge; NaN when its length is
  int strongest_particle = 0;
  double strongest_force = 0.0; ///< N
};

/// Milliseconds of one frame.
struct SolverTimes {
  double broad = 0.0, cloth = 0.0, contact = 0.0;
};

struct ContactCounts {
  std::int64_t searches = 0;   ///< broad phases
  std::int64_t candidates = 0; ///< pairs the broad phases gave
  std::int64_t queries = 0;    ///< narrow-phase calls
  std::int64_t contacts = 0;   ///< projections
};

/// What the last broad phase looked at and gave, in compressed rows like proxies::Candidates: for pictures.
struct BroadPhaseView {
  std::span<const proxies::Box> boxes;   ///< of tiles, grown by their reach, world; empty where each particle is asked
  std::span<const int> begin, colliders; ///< of each box, or of each particle
};

/// Since the solver was made; all 0 without SolverOptions::self_collision.
struct SelfCollisionCounts {
  std::int64_t substeps = 0;
  std::int64_t searches = 0;   ///< spatial hashes built
  std::int64_t candidates = 0; ///< pairs they gave
  std::int64_t tests = 0;      ///< pairs whose distance was measured
  std::int64_t contacts = 0;   ///< pairs that were pushed apart
  std::int64_t slowed = 0;     ///< particles whose way in a substep was cut
  std::int64_t loose = 0;      ///< pairs for which the bound of self_collision.h was not kept in a substep
};

/// forces += those of all springs at `positions`: for spring (i, j), K (|d| - L) d/|d| on i with d = x_j - x_i, the
/// opposite on j. N. Returns the index of the first structural spring whose length is not within
/// (1 + k_diverged_stretch) of its rest length.
std::optional<int> add_spring_forces(const Garment& garment, std::span<const Vec3> positions, std::span<Vec3> forces);

/// Sum of K (|d| - L)^2 / 2 over all springs, J. The forces are its negative gradient.
double elastic_energy(const Garment& garment, std::span<const Vec3> positions);

/// One garment in motion. The garment must outlive it; its memory is allocated once.
class Solver {
public:
  virtual ~Solver() = default;

  /// At rest at these positions (world, one a particle).
  virtual void reset(std::span<const Vec3> positions) = 0;

  /// In motion as in `state`, which particles() gave earlier: how a bad frame is taken back.
  virtual void restore(const Particles& state) = 0;

  /// One frame in `input.substeps` equal substeps. On divergence the state is that of the substep in which it happened.
  virtual std::optional<Divergence> step(const FrameInput& input, proxies::CollisionQuery& query) = 0;

  virtual const Particles& particles() const = 0;
  virtual const SolverTimes& times() const = 0; ///< of the last frame
  virtual const ContactCounts& contact_counts() const = 0;
  virtual BroadPhaseView broad_phase() const { return {}; } ///< good until the next step()
  virtual SelfCollisionCounts self_collision_counts() const { return {}; }
};

enum class SolverKind {
  mass_spring, ///< the report's, and the plain form to compare with
  xpbd         ///< extended position-based dynamics in small steps, threads solved as wholes
};

/// What of the cloth meets colliders, besides its particles.
enum class ContactFeatures {
  automatic, ///< triangles where a cell of the garment is larger than the smallest collider in reach
  particles, ///< nothing besides
  triangles  ///< with their edges
};
inline constexpr std::array<std::string_view, 3> k_contact_features_names = {"auto", "particles", "triangles"};
ContactFeatures contact_features_named(std::string_view name); ///< like solver_named

struct SolverOptions {
  SolverKind kind = SolverKind::xpbd;
  ContactFeatures features = ContactFeatures::automatic;
  int passes = 1;    ///< xpbd: over the constraints, a substep; more than one pays on fine sheets (256 a side)
  bool swept = true; ///< contacts by time of impact where something moves farther than it is thick
  bool self_collision = false;   ///< particles of the garment keep apart (self_collision.h)
  bool double_precision = false; ///< of the kernels: for references
};

/// As in scene files and on the command line, in the order of SolverKind.
inline constexpr std::array<std::string_view, 2> k_solver_names = {"mass_spring", "xpbd"};
std::string_view name_of(SolverKind kind);
SolverKind solver_named(std::string_view name); ///< one of k_solver_names; std::invalid_argument for any other
std::unique_ptr<Solver> make_solver(const Garment& garment, const SolverOptions& options);

} // namespace tutu::cloth
