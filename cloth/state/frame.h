// What a solver is given for a frame, and what it tells of it.
#pragma once

#include "proxies/motion/collider_set.h"
#include "rig/math.h"

#include <atomic>
#include <cstdint>
#include <span>

namespace tutu::cloth {

class ContactSet;

/// Everything outside the garment during one frame.
struct FrameInput {
  proxies::SweptColliders colliders;
  /// Coulomb coefficient of each collider, then the ground, then the true body; empty: none anywhere.
  std::span<const double> friction;
  std::span<const Vec3> pins_start, pins_end; ///< targets in the order of Garment::pins, world, m
  double seconds = 1.0 / 60.0;
  int substeps = 5;                                        ///< >= 1
  Vec3 gravity = {0.0, -9.81, 0.0};                        ///< m/s2
  Vec3 wind_start = Vec3::Zero(), wind_end = Vec3::Zero(); ///< world, m/s: for garments with Fabric::air
  double extra_drag = 0.0;                                 ///< 1/s on top of the fabric's: settles a drape
  /// Where there is one, solvers look at it between substeps, and once it is true end the frame there (Stopped). Not
  /// owned; any thread may set it.
  const std::atomic<bool>* stop = nullptr;
  /// Where there is one, solvers keep in it what they do at colliders. Not owned; of this garment alone.
  ContactSet* contacts = nullptr;

  Vec3 wind_at(double s) const { return (1.0 - s) * wind_start + s * wind_end; } ///< at `s` in [0, 1] of the frame
  bool is_stopped() const { return stop && stop->load(std::memory_order_relaxed); }
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

  friend ContactCounts operator+(const ContactCounts& a, const ContactCounts& b) {
    return {a.searches + b.searches, a.candidates + b.candidates, a.queries + b.queries, a.contacts + b.contacts};
  }
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

} // namespace tutu::cloth
