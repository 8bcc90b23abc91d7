#include "src/study/chart/pareto.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace tutu::app {

bool dominates(std::span<const double> a, std::span<const double> b) {
  bool better = false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k] > b[k]) return false;
    better = better || a[k] < b[k];
  }
  return better;
}

std::vector<int> pareto_front(std::span<const CostAndError> points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return std::tuple(points[i].cost, points[i].error, i); };
  std::sort(order.begin(), order.end(), [&](int i, int j) { return key(i) < key(j); });
  std::vector<int> front;
  double least = std::numeric_limits<double>::infinity();
  for (const int i : order) {
    const bool as_good =
        !front.empty() && points[front.back()].cost == points[i].cost && points[front.back()].error == points[i].error;
    if (!as_good && !(points[i].error < least)) continue;
    least = points[i].error;
    front.push_back(i);
  }
  return front;
}

} // namespace tutu::app
