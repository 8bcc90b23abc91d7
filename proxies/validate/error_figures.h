// Mean, RMS, percentiles and largest of very many errors, each with a weight.
#pragma once

#include <vector>

namespace tutu::proxies {

/// All m; 0 where there was nothing.
struct ErrorFigures {
  double mean = 0.0, rms = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
};

/// Gathers errors >= 0 in a bounded amount of memory. Mean, RMS and largest are exact; a percentile is the upper end of
/// the bin it falls in, so at most k_bin too large. The same errors in the same order give the same bits.
class ErrorGatherer {
public:
  static constexpr double k_bin = 1e-5;   ///< m: a hundredth of a millimetre
  static constexpr int k_most_bins = 1e5; ///< up to 1 m apart; what is beyond counts as being there

  void add(double error, double weight);
  ErrorFigures figures() const;
  double weight() const { return weight_; }

private:
  double percentile(double share) const;

  std::vector<double> bins_; ///< weight in (k - 1, k] * k_bin; the first holds zeros
  double weight_ = 0.0, sum_ = 0.0, squares_ = 0.0, max_ = 0.0;
};

} // namespace tutu::proxies
