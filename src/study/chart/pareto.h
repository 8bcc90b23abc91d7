// Which of some settings are worth a look: those that no other is better than in every respect.
#pragma once

#include <span>
#include <vector>

namespace tutu::app {

/// Less is better. `a` dominates `b` when it is nowhere worse and somewhere better. Equal lengths.
bool dominates(std::span<const double> a, std::span<const double> b);

struct CostAndError {
  double cost = 0.0, error = 0.0;
};

/// Indices of the points that none dominates, by rising cost (so falling error); of equal points all. Sorting and one
/// pass. Points must be finite.
std::vector<int> pareto_front(std::span<const CostAndError> points);

} // namespace tutu::app
