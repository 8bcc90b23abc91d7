// How good a state is: threads longer and shorter than at rest, jitter. Plain double measurements, outside every
// timing.
//
// A thread is a structural spring: from a particle to its neighbour along warp or weft; of a mesh, an edge. Its strain
// is length / rest length - 1, with its sign. Everywhere a run is reported:
//
//   longer       max(0, strain) of every free thread, those that are shorter among them: 99 % are no longer than its
//   p99 shorter      max(0, -strain) of the same held_longer  as longer, of the held threads
//
// Free is what has something that the solver moves; a thread between two pins is held: how long that chord is comes
// from where it was pinned and is no work of the solver.
#pragma once

#include "cloth/garment/garment.h"
#include "cloth/state/particles.h"

#include <array>
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

/// What of a garment is free and what is held, found once, so that measuring a frame looks nothing up and allocates
/// nothing. The garment must outlive it.
struct MeasuredParts {
  explicit MeasuredParts(const Garment& garment);

  const Garment* garment;
  std::vector<std::uint8_t> pinned;            ///< [particle]
  std::vector<int> free_threads, held_threads; ///< in Garment::springs
  std::vector<std::array<std::uint32_t, 3>> free_triangles;
};

/// length / rest length - 1.
double strain_of(const Spring& thread, std::span<const Vec3> positions);
/// The same of every thread, held ones among them, in the order of Garment::springs.
std::vector<double> strains_of(const Garment& garment, const Particles& particles);

/// How far threads are from their rest length, by the names above. Not in per cent.
struct ThreadStrains {
  Spread longer, shorter, held_longer;
};

/// Of one frame, exactly.
ThreadStrains thread_strains(const MeasuredParts& parts, std::span<const Vec3> positions);

/// Of any number of frames: every thread of every frame is a sample.
class ThreadStrainGatherer {
public:
  void add(const MeasuredParts& parts, std::span<const Vec3> positions);
  ThreadStrains strains() const { return {longer_.spread(), shorter_.spread(), held_longer_.spread()}; }

private:
  SpreadGatherer longer_, shorter_, held_longer_;
};

/// The free thread that is longest compared with its rest length.
struct LongestThread {
  double longer = 0.0; ///< its strain; 0: none is longer than at rest
  int i = 0, j = 0;    ///< its particles
};
LongestThread longest_thread(const MeasuredParts& parts, std::span<const Vec3> positions);
inline Vec3 middle_of(const LongestThread& thread, std::span<const Vec3> positions) {
  return 0.5 * (positions[thread.i] + positions[thread.j]);
}

/// Mean |x(f+1) - 2 x(f) + x(f-1)| / frame^2 over free particles, m/s2.
double jitter_of(const MeasuredParts& parts, std::span<const Vec3> before_last, std::span<const Vec3> last,
                 std::span<const Vec3> now, double frame_seconds);

} // namespace tutu::cloth
