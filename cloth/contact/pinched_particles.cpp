#include "cloth/contact/pinched_particles.h"

#include <algorithm>

namespace tutu::cloth {

void PinchedParticles::begin_substep() {
  if (std::ranges::all_of(left_, [](std::uint8_t left) { return left == 0; })) return;
  before_ = left_;
  for (std::size_t i = 0; i < left_.size(); ++i) {
    if (before_[i] == 0) continue;
    if (left_[i] == before_[i]) --left_[i]; // no neighbour before it raised it
    if (before_[i] <= k_fewer_a_thread) continue;
    for (const BetweenColliders::Thread& thread : between_.threads_of(static_cast<int>(i)))
      left_[thread.other] = std::max<std::uint8_t>(left_[thread.other], before_[i] - k_fewer_a_thread);
  }
}

} // namespace tutu::cloth
