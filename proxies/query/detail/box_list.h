// Which moving colliders come near a box, by asking each: the broad phase where colliders are few.
#pragma once

#include "proxies/shapes.h"

#include <array>
#include <span>
#include <vector>

namespace tutu::proxies {

/// The face of BroadPhase, without a tree. Safe to ask from several threads at once.
class BoxList {
public:
  /// Takes the colliders of a frame; the spans must be of one length. Allocates only when there are more than before.
  void update(std::span<const Capsule> start, std::span<const Capsule> end);

  /// Appends the index of every collider whose swept box touches `box`, rising.
  void overlaps(const Box& box, std::vector<int>& out) const;

private:
  std::array<std::vector<double>, 3> low_, high_; // swept boxes, m: one array an axis
};

} // namespace tutu::proxies
