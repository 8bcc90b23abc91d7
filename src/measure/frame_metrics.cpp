#include "src/measure/frame_metrics.h"

#include "cloth/metrics.h"
#include "proxies/distance/signed_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tutu::app {
namespace {

double depth_of(const Vec3& point, const proxies::Capsule& proxy) {
  return -proxies::signed_distance(point, proxy).distance;
}

std::array<Vec3, 3> corners_of(const std::array<std::uint32_t, 3>& triangle, std::span<const Vec3> positions) {
  return {positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]};
}

Vec3 centroid_of(const std::array<Vec3, 3>& corners) { return (corners[0] + corners[1] + corners[2]) / 3.0; }

/// Greatest depth of the samples of one triangle below one proxy; may be negative.
double deepest_sample(const std::array<Vec3, 3>& corners, const proxies::Capsule& proxy) {
  constexpr int k_parts = 6;
  static_assert((k_parts + 1) * (k_parts + 2) / 2 == k_surface_samples);
  double deepest = depth_of(corners[0], proxy);
  for (int i = 0; i <= k_parts; ++i)
    for (int j = 0; i + j <= k_parts; ++j) {
      const int k = k_parts - i - j;
      const Vec3 sample = (i * corners[0] + j * corners[1] + k * corners[2]) / k_parts;
      deepest = std::max(deepest, depth_of(sample, proxy));
    }
  return deepest;
}

/// length / rest length - 1 of each grid edge with a free end.
std::vector<double> strains_of(const cloth::Garment& garment, std::span<const Vec3> positions) {
  std::vector<std::uint8_t> pinned(garment.rest_positions.size(), 0);
  for (const cloth::Pin& pin : garment.pins) pinned[pin.particle] = 1;
  std::vector<double> strains;
  strains.reserve(garment.structural_count);
  for (int k = 0; k < garment.structural_count; ++k) {
    const cloth::Spring& edge = garment.springs[k];
    if (pinned[edge.i] && pinned[edge.j]) continue;
    strains.push_back((positions[edge.j] - positions[edge.i]).norm() / edge.rest_length - 1.0);
  }
  return strains;
}

double mean_of(std::span<const double> values) {
  return values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

double deepest_surface_sample(const cloth::Garment& garment, std::span<const Vec3> positions,
                              std::span<const proxies::Capsule> proxies) {
  double deepest = 0.0;
  for (const auto& triangle : garment.triangles) {
    const std::array<Vec3, 3> corners = corners_of(triangle, positions);
    const Vec3 centroid = centroid_of(corners);
    double reach = 0.0; // no sample is farther from the centroid
    for (const Vec3& corner : corners) reach = std::max(reach, (corner - centroid).norm());
    for (const proxies::Capsule& proxy : proxies)
      if (depth_of(centroid, proxy) + reach > deepest) deepest = std::max(deepest, deepest_sample(corners, proxy));
  }
  return deepest;
}

FrameMetrics measure_frame(const cloth::Garment& garment, const cloth::Particles& particles, std::span<const Vec3> last,
                           std::span<const Vec3> before_last, std::span<const proxies::Capsule> proxies,
                           double frame_seconds) {
  FrameMetrics m;
  const std::span<const Vec3> positions = particles.positions;

  const std::vector<double> depths = cloth::penetration_of(garment, particles, proxies, std::nullopt);
  const auto deep = std::count_if(depths.begin(), depths.end(), [](double depth) { return depth > k_counted_depth; });
  m.pen_max = depths.empty() ? 0.0 : *std::max_element(depths.begin(), depths.end());
  m.pen_mean = mean_of(depths);
  m.pen_share = depths.empty() ? 0.0 : static_cast<double>(deep) / static_cast<double>(depths.size());

  double sum = 0.0;
  for (const auto& triangle : garment.triangles) {
    const Vec3 centroid = centroid_of(corners_of(triangle, positions));
    double depth = 0.0;
    for (const proxies::Capsule& proxy : proxies) depth = std::max(depth, depth_of(centroid, proxy));
    m.cen_max = std::max(m.cen_max, depth);
    sum += depth;
  }
  m.cen_mean = sum / static_cast<double>(garment.triangles.size());
  m.surf_max = deepest_surface_sample(garment, positions, proxies);

  std::vector<double> strains = strains_of(garment, positions);
  m.longest = *std::max_element(strains.begin(), strains.end());
  for (double& strain : strains) strain = std::abs(strain);
  const cloth::Spread stretch = cloth::spread(std::move(strains));
  m.stretch_max = stretch.max;
  m.stretch_p99 = stretch.p99;
  m.stretch_mean = stretch.mean;

  m.jitter = cloth::jitter_of(garment, before_last, last, positions, frame_seconds);
  for (int column = 0; column < garment.columns; ++column)
    m.hem_y += positions[(garment.rows - 1) * garment.columns + column].y() / garment.columns;
  return m;
}

RunMetrics summarise(std::span<const FrameMetrics> frames, std::span<const double> ms) {
  std::vector<double> values(frames.size());
  const auto gather = [&](double FrameMetrics::*member) -> std::vector<double>& {
    std::transform(frames.begin(), frames.end(), values.begin(), [&](const FrameMetrics& f) { return f.*member; });
    return values;
  };
  const auto over_frames = [&](double FrameMetrics::*member) -> OverFrames {
    const double max = cloth::percentile(gather(member), 1.0);
    return {max, cloth::percentile(values, 0.5)};
  };
  const auto mean = [&](double FrameMetrics::*member) { return mean_of(gather(member)); };

  RunMetrics run;
  run.frames = static_cast<int>(frames.size());
  run.pen = over_frames(&FrameMetrics::pen_max);
  run.cen = over_frames(&FrameMetrics::cen_max);
  run.surf = over_frames(&FrameMetrics::surf_max);
  run.stretch = over_frames(&FrameMetrics::stretch_max);
  run.longest = over_frames(&FrameMetrics::longest);
  run.pen_mean = mean(&FrameMetrics::pen_mean);
  run.pen_share = mean(&FrameMetrics::pen_share);
  run.cen_mean = mean(&FrameMetrics::cen_mean);
  run.stretch_p99 = mean(&FrameMetrics::stretch_p99);
  run.stretch_mean = mean(&FrameMetrics::stretch_mean);
  run.jitter = mean(&FrameMetrics::jitter);
  run.hem_y = mean(&FrameMetrics::hem_y);
  std::vector<double> times(ms.begin(), ms.end());
  run.ms_median = cloth::percentile(times, 0.5);
  run.ms_p99 = cloth::percentile(times, 0.99);
  return run;
}

} // namespace tutu::app
