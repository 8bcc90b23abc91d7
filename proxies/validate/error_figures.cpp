#include "proxies/validate/error_figures.h"

#include <algorithm>
#include <cmath>

namespace tutu::proxies {

void ErrorGatherer::add(double error, double weight) {
  if (!(weight > 0.0)) return;
  const double bin = std::min(std::ceil(error / k_bin), double{k_most_bins});
  const auto index = static_cast<std::size_t>(bin);
  if (index >= bins_.size()) bins_.resize(index + 1, 0.0);
  bins_[index] += weight;
  weight_ += weight;
  sum_ += weight * error;
  squares_ += weight * error * error;
  max_ = std::max(max_, error);
}

double ErrorGatherer::percentile(double share) const {
  // Sums in another order than weight_ may fall short of it by rounding: then the last bin it is.
  double seen = 0.0;
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    seen += bins_[k];
    if (seen >= share * weight_) return std::min(max_, static_cast<double>(k) * k_bin);
  }
  return max_;
}

ErrorFigures ErrorGatherer::figures() const {
  if (!(weight_ > 0.0)) return {};
  return {sum_ / weight_, std::sqrt(squares_ / weight_), percentile(0.95), percentile(0.99), max_};
}

} // namespace tutu::proxies
