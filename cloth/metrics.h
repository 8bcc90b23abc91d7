// How good a state is: stretch, penetration, jitter. Plain double measurements, outside every timing.
#pragma once

#include "cloth/garment/garment.h"
#include "cloth/state/particles.h"
#include "proxies/shapes.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tutu::cloth {

/// Largest, mean and 99th percentile of some samples; all 0 when there are none.
struct Spread {
  double max = 0.0, p99 = 0.0, mean = 0.0;
};

/// The smallest sample that at least `share` of them do not exceed (nearest rank); 0 for no samples. Reorders
/// `samples`.
double percentile(std::vector<double>& samples, double share);
Spread spread(std::vector<double> samples);

/// Gathers any number of samples >= 0 in a fixed amount of memory. Largest and mean are exact; percentiles are those of
/// a histogram with 64 bins an octave, so they are at most 1.1 % too large.
class SpreadGatherer {
public:
  void add(double sample);
  Spread spread() const;
  double percentile(double share) const; ///< nearest rank; 0 for no samples
  std::int64_t count() const { return count_; }

private:
  static constexpr int k_bins_an_octave = 64, k_lowest_octave = -40, k_highest_octave = 24;
  std::vector<std::int64_t> bins_ = std::vector<std::int64_t>(k_bins_an_octave * (k_highest_octave - k_lowest_octave));
  std::int64_t count_ = 0, below_ = 0; ///< below: samples under 2^k_lowest_octave, zero among them
  double sum_ = 0.0, max_ = 0.0;
};

/// The same for percentiles alone, exact up to k_exact samples (a sample a frame: 4.5 minutes at 60 frames/s). Of more
/// than that all still count, and percentiles are those of SpreadGatherer.
class PercentileGatherer {
public:
  static constexpr std::size_t k_exact = 16384;

  void add(double sample);
  double percentile(double share) const; ///< nearest rank; 0 for no samples

private:
  std::vector<double> first_;         ///< all, while they are few
  std::optional<SpreadGatherer> all_; ///< once they are not
};

/// length / rest length - 1 of every structural spring: negative where it is pressed together.
std::vector<double> stretch_of(const Garment& garment, const Particles& particles);

/// Depth of every free particle below the nearest collider surface, m, >= 0, over all colliders, closed form.
std::vector<double> penetration_of(const Garment& garment, const Particles& particles,
                                   std::span<const proxies::Capsule> colliders,
                                   const std::optional<proxies::Plane>& ground);

/// Mean |x(f+1) - 2 x(f) + x(f-1)| / frame^2 over free particles, m/s2.
double jitter_of(const Garment& garment, std::span<const Vec3> before_last, std::span<const Vec3> last,
                 std::span<const Vec3> now, double frame_seconds);

} // namespace tutu::cloth
