// Which moving colliders come near a box: FCL's dynamic tree of boxes behind a face that shows no FCL.
#pragma once

#include "proxies/shapes.h"

#include <memory>
#include <span>
#include <vector>

namespace tutu::proxies {

/// Not for use from several threads at once.
class BroadPhase {
public:
  BroadPhase();
  ~BroadPhase();
  BroadPhase(const BroadPhase&) = delete;
  BroadPhase& operator=(const BroadPhase&) = delete;

  /// Takes the colliders of a frame; once a frame, before `overlaps`. The spans must be finite and of one length, which
  /// may differ from the last call's. The tree is built anew when it does, and refitted when not.
  void update(std::span<const Capsule> start, std::span<const Capsule> end);

  /// Appends the index of every collider whose swept box touches `box` (finite, not empty), each once, in no particular
  /// order.
  void overlaps(const Box& box, std::vector<int>& out);

private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

} // namespace tutu::proxies
