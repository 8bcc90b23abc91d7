// What the standard scenes measure of a frame and of a run. Plain double, outside every timing.
#pragma once

#include "cloth/state/particles.h"
#include "src/measure/cloth_depths.h"

#include <span>
#include <vector>

namespace tutu::app {

/// One frame. Depths are max(0, -signed distance) below the deepest of all proxies, m.
struct FrameMetrics {
  double pen_max = 0.0, pen_mean = 0.0; ///< m, of free particles
  double pen_share = 0.0;               ///< of free particles deeper than k_counted_depth, 0..1
  double cen_max = 0.0, cen_mean = 0.0; ///< m, at the centroids of triangles with a free corner
  double surface = 0.0;                 ///< m, at k_surface_samples points of each of those
  cloth::ThreadStrains strains;
  double jitter = 0.0; ///< mean |x(f+1) - 2 x(f) + x(f-1)| / frame^2 of free particles, m/s2
  double hem_y = 0.0;  ///< mean height of the last row, m
};

inline constexpr double k_counted_depth = 0.001; ///< m

/// `last` and `before_last` are the positions one and two frames ago. `probe` is of a garment in rows and columns.
FrameMetrics measure_frame(const ClothProbe& probe, std::span<const Vec3> positions, std::span<const Vec3> last,
                           std::span<const Vec3> before_last, std::span<const proxies::Capsule> proxies,
                           double frame_seconds);

/// A frame's worst, over a run: the worst frame, the middle frame.
struct OverFrames {
  double max = 0.0, median = 0.0;
};

/// Of threads: `worst` is of each frame's worst; the others are means over the frames of the frame's own figure.
struct StrainOverFrames {
  OverFrames worst;
  double p99 = 0.0, mean = 0.0;
};

/// A run. Means, shares, jitter and hem_y are means over the frames of the frame's own figure.
struct RunMetrics {
  int frames = 0; ///< measured
  OverFrames pen, cen, surface;
  double pen_mean = 0.0, pen_share = 0.0, cen_mean = 0.0;
  StrainOverFrames longer, shorter, held_longer;
  double jitter = 0.0, hem_y = 0.0;
  double ms_median = 0.0, ms_p99 = 0.0;
};

/// `ms`: one entry a measured frame, as `frames`.
RunMetrics summarise(std::span<const FrameMetrics> frames, std::span<const double> ms);

} // namespace tutu::app
