// Which particles of a garment are caught between colliders, where each particle is asked for itself (ContactSearch).
#pragma once

#include "cloth/contact/between_colliders.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tutu::cloth {

/// A particle that two colliders pushed against each other, or that what holds it keeps within one, is settled by
/// BetweenColliders from the next substep on, and those around it with it: what pushes them must not tear what it
/// holds.
class PinchedParticles {
public:
  explicit PinchedParticles(const Garment& garment) : between_(garment), left_(garment.rest_positions.size(), 0) {}

  const BetweenColliders& between() const { return between_; }
  bool is_pinched(int particle) const { return left_[particle] > 0; }
  void note(int particle) { left_[particle] = k_pinched_for; }
  void begin_substep(); ///< counts down, and spreads to the neighbours
  void forget() { std::fill(left_.begin(), left_.end(), std::uint8_t{0}); }

private:
  /// Substeps that a particle is settled after it was pinched, and how many fewer its neighbours are: seven threads on.
  static constexpr std::uint8_t k_pinched_for = 16, k_fewer_a_thread = 2;

  BetweenColliders between_;
  std::vector<std::uint8_t> left_, before_; ///< substeps; room
};

} // namespace tutu::cloth
