#include "cloth/metrics.h"

#include "proxies/distance/signed_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tutu::cloth {
double percentile(std::vector<double>& samples, double share) {
  if (samples.empty()) return 0.0;
  const double rank = std::ceil(share * static_cast<double>(samples.size())) - 1.0;
  const auto index = static_cast<std::size_t>(std::clamp(rank, 0.0, static_cast<double>(samples.size() - 1)));
  std::nth_element(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(index), samples.end());
  return samples[index];
}

Spread spread(std::vector<double> samples) {
  if (samples.empty()) return {};
  Spread result;
  result.max = *std::max_element(samples.begin(), samples.end());
  result.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  result.p99 = percentile(samples, 0.99);
  return result;
}

void SpreadGatherer::add(double sample) {
  ++count_;
  sum_ += sample;
  max_ = std::max(max_, sample);
  const double octave = sample > 0.0 ? std::log2(sample) - k_lowest_octave : -1.0;
  if (octave < 0.0) {
    ++below_;
    return;
  }
  const auto bin = static_cast<std::size_t>(std::min(octave * k_bins_an_octave, static_cast<double>(bins_.size() - 1)));
  ++bins_[bin];
}

Spread SpreadGatherer::spread() const {
  if (count_ == 0) return {};
  return {max_, percentile(0.99), sum_ / static_cast<double>(count_)};
}

double SpreadGatherer::percentile(double share) const {
  const auto rank = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_)));
  std::int64_t seen = below_;
  for (std::size_t bin = 0; seen < rank && bin < bins_.size(); ++bin) {
    seen += bins_[bin];
    const double upper = std::exp2(k_lowest_octave + static_cast<double>(bin + 1) / k_bins_an_octave);
    if (seen >= rank) return std::min(upper, max_);
  }
  return 0.0;
}

void PercentileGatherer::add(double sample) {
  if (all_) return all_->add(sample);
  first_.push_back(sample);
  if (first_.size() <= k_exact) return;
  all_.emplace();
  for (const double early : first_) all_->add(early);
  first_ = {};
}

double PercentileGatherer::percentile(double share) const {
  if (all_) return all_->percentile(share);
  std::vector<double> samples = first_;
  return cloth::percentile(samples, share);
}

std::vector<double> stretch_of(const Garment& garment, const Particles& particles) {
  std::vector<double> stretch(garment.structural_count);
  for (int k = 0; k < garment.structural_count; ++k) {
    const Spring& spring = garment.springs[k];
    stretch[k] = (particles.positions[spring.j] - particles.positions[spring.i]).norm() / spring.rest_length - 1.0;
  }
  return stretch;
}

std::vector<double> penetration_of(const Garment& garment, const Particles& particles,
                                   std::span<const proxies::Capsule> colliders,
                                   const std::optional<proxies::Plane>& ground) {
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  std::vector<double> depths;
  depths.reserve(particles.positions.size());
  for (int i = 0; i < particles.count(); ++i) {
    if (pinned[i]) continue;
    double depth = 0.0;
    for (const proxies::Capsule& collider : colliders)
      depth = std::max(depth, -proxies::signed_distance(particles.positions[i], collider).distance);
    if (ground) depth = std::max(depth, -proxies::signed_distance(particles.positions[i], *ground).distance);
    depths.push_back(depth);
  }
  return depths;
}

double jitter_of(const Garment& garment, std::span<const Vec3> before_last, std::span<const Vec3> last,
                 std::span<const Vec3> now, double frame_seconds) {
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  double sum = 0.0;
  int free = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (pinned[i]) continue;
    sum += (now[i] - 2.0 * last[i] + before_last[i]).norm();
    ++free;
  }
  return free > 0 ? sum / free / (frame_seconds * frame_seconds) : 0.0;
}

} // namespace tutu::cloth
