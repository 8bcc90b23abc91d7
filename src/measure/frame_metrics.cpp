#include "src/measure/frame_metrics.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace tutu::app {

FrameMetrics measure_frame(const ClothProbe& probe, std::span<const Vec3> positions, std::span<const Vec3> last,
                           std::span<const Vec3> before_last, std::span<const proxies::Capsule> proxies,
                           double frame_seconds) {
  FrameMetrics m;
  ClothDepths depths;
  probe.measure(proxies, std::nullopt, positions, depths);
  const auto deep = std::count_if(depths.particle_depths.begin(), depths.particle_depths.end(),
                                  [](double depth) { return depth > k_counted_depth; });
  m.pen_max = depths.particles.deepest;
  m.pen_mean = depths.particles.mean();
  m.pen_share = static_cast<double>(deep) / static_cast<double>(std::max<std::int64_t>(1, depths.particles.asked));
  m.cen_max = depths.triangles.deepest;
  m.cen_mean = depths.triangles.mean();
  m.surface = depths.surface;
  m.strains = cloth::thread_strains(probe.parts(), positions);
  m.jitter = cloth::jitter_of(probe.parts(), before_last, last, positions, frame_seconds);
  const cloth::Garment& garment = *probe.parts().garment;
  for (int column = 0; column < garment.columns; ++column)
    m.hem_y += positions[(garment.rows - 1) * garment.columns + column].y() / garment.columns;
  return m;
}

RunMetrics summarise(std::span<const FrameMetrics> frames, std::span<const double> ms) {
  using Figure = std::function<double(const FrameMetrics&)>;
  std::vector<double> values(frames.size());
  const auto gather = [&](const Figure& figure) {
    std::transform(frames.begin(), frames.end(), values.begin(), figure);
  };
  const auto over_frames = [&](const Figure& figure) -> OverFrames {
    gather(figure);
    const double max = cloth::percentile(values, 1.0);
    return {max, cloth::percentile(values, 0.5)};
  };
  const auto mean = [&](const Figure& figure) {
    gather(figure);
    return values.empty() ? 0.0
                          : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const auto strain = [&](cloth::Spread cloth::ThreadStrains::*which) -> StrainOverFrames {
    return {over_frames([which](const FrameMetrics& f) { return (f.strains.*which).max; }),
            mean([which](const FrameMetrics& f) { return (f.strains.*which).p99; }),
            mean([which](const FrameMetrics& f) { return (f.strains.*which).mean; })};
  };

  RunMetrics run;
  run.frames = static_cast<int>(frames.size());
  run.pen = over_frames(&FrameMetrics::pen_max);
  run.cen = over_frames(&FrameMetrics::cen_max);
  run.surface = over_frames(&FrameMetrics::surface);
  run.pen_mean = mean(&FrameMetrics::pen_mean);
  run.pen_share = mean(&FrameMetrics::pen_share);
  run.cen_mean = mean(&FrameMetrics::cen_mean);
  run.longer = strain(&cloth::ThreadStrains::longer);
  run.shorter = strain(&cloth::ThreadStrains::shorter);
  run.held_longer = strain(&cloth::ThreadStrains::held_longer);
  run.jitter = mean(&FrameMetrics::jitter);
  run.hem_y = mean(&FrameMetrics::hem_y);
  std::vector<double> times(ms.begin(), ms.end());
  run.ms_median = cloth::percentile(times, 0.5);
  run.ms_p99 = cloth::percentile(times, 0.99);
  return run;
}

} // namespace tutu::app
