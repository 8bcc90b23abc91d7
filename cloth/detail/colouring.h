// Which constraints may be solved at the same time.
#pragma once

#include <span>
#include <vector>

namespace tutu::cloth {

/// Orders elements so that no two of one colour share a particle: greedily, each gets the lowest colour that is free at
/// all its particles. `elements` are `arity` particles each, one after the other. Same input, same order.
struct Colouring {
  std::vector<int> order; ///< of the elements: colour by colour, rising within one
  std::vector<int> begin; ///< where each colour starts in `order`, and its end: colours + 1 entries
};
Colouring colour(std::span<const int> elements, int arity, int particle_count);

} // namespace tutu::cloth
