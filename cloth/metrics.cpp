#include "cloth/metrics.h"

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

MeasuredParts::MeasuredParts(const Garment& of) : garment(&of), pinned(pinned_flags(of)) {
  for (int k = 0; k < of.structural_count; ++k) {
    const bool held = pinned[of.springs[k].i] && pinned[of.springs[k].j];
    (held ? held_threads : free_threads).push_back(k);
  }
  for (const auto& t : of.triangles)
    if (!pinned[t[0]] || !pinned[t[1]] || !pinned[t[2]]) free_triangles.push_back(t);
}

double strain_of(const Spring& thread, std::span<const Vec3> positions) {
  return (positions[thread.j] - positions[thread.i]).norm() / thread.rest_length - 1.0;
}

std::vector<double> strains_of(const Garment& garment, const Particles& particles) {
  std::vector<double> strains(garment.structural_count);
  for (int k = 0; k < garment.structural_count; ++k) strains[k] = strain_of(garment.springs[k], particles.positions);
  return strains;
}

namespace {

/// Gives every free thread's lengthening and shortening, and every held one's lengthening, to what gathers them.
template <class Longer, class Shorter, class HeldLonger>
void tell_strains(const MeasuredParts& parts, std::span<const Vec3> positions, const Longer& longer,
                  const Shorter& shorter, const HeldLonger& held_longer) {
  for (const int k : parts.free_threads) {
    const double strain = strain_of(parts.garment->springs[k], positions);
    longer(std::max(strain, 0.0));
    shorter(std::max(-strain, 0.0));
  }
  for (const int k : parts.held_threads) held_longer(std::max(strain_of(parts.garment->springs[k], positions), 0.0));
}

} // namespace

ThreadStrains thread_strains(const MeasuredParts& parts, std::span<const Vec3> positions) {
  std::vector<double> longer, shorter, held_longer;
  const auto into = [](std::vector<double>& samples) { return [&](double sample) { samples.push_back(sample); }; };
  tell_strains(parts, positions, into(longer), into(shorter), into(held_longer));
  return {spread(std::move(longer)), spread(std::move(shorter)), spread(std::move(held_longer))};
}

void ThreadStrainGatherer::add(const MeasuredParts& parts, std::span<const Vec3> positions) {
  const auto into = [](SpreadGatherer& samples) { return [&](double sample) { samples.add(sample); }; };
  tell_strains(parts, positions, into(longer_), into(shorter_), into(held_longer_));
}

LongestThread longest_thread(const MeasuredParts& parts, std::span<const Vec3> positions) {
  LongestThread longest;
  for (const int k : parts.free_threads) {
    const Spring& thread = parts.garment->springs[k];
    const double strain = strain_of(thread, positions);
    if (strain > longest.longer) longest = {strain, thread.i, thread.j};
  }
  return longest;
}

double jitter_of(const MeasuredParts& parts, std::span<const Vec3> before_last, std::span<const Vec3> last,
                 std::span<const Vec3> now, double frame_seconds) {
  double sum = 0.0;
  int free = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (parts.pinned[i]) continue;
    sum += (now[i] - 2.0 * last[i] + before_last[i]).norm();
    ++free;
  }
  return free > 0 ? sum / free / (frame_seconds * frame_seconds) : 0.0;
}

} // namespace tutu::cloth
