#include "proxies/fit_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tutu::proxies::fit {
namespace {

constexpr float k_infinite = std::numeric_limits<float>::infinity();

/// Lanes of one block against one shape. Plain loops that the compiler turns into vectors.
void distances(const float* x, const float* y, const float* z, const PosedShapes& shapes, std::size_t s, float* out) {
  const float ax = shapes.ax[s], ay = shapes.ay[s], az = shapes.az[s], dx = shapes.dx[s], dy = shapes.dy[s],
              dz = shapes.dz[s];
  const float inverse = shapes.inverse_square[s], radius = shapes.radius[s];
  for (int k = 0; k < k_lanes; ++k) {
    const float px = x[k] - ax, py = y[k] - ay, pz = z[k] - az;
    float t = (px * dx + py * dy + pz * dz) * inverse;
    t = t < 0.0f ? 0.0f : t;
    t = t > 1.0f ? 1.0f : t;
    const float vx = px - t * dx, vy = py - t * dy, vz = pz - t * dz;
    out[k] = std::sqrt(vx * vx + vy * vy + vz * vz) - radius;
  }
}

/// The shapes that could be nearest to a point within `reach` of `centre` (or second nearest): distances from its
/// centre differ by at most `reach` from those of its points.
class Candidates {
public:
  std::span<const int> find(const PosedShapes& shapes, int pose, const Vec3f& centre, float reach, bool second) {
    const std::size_t first = static_cast<std::size_t>(pose) * shapes.count;
    from_centre_.resize(shapes.count);
    for (int s = 0; s < shapes.count; ++s) {
      const std::size_t i = first + s;
      const float px = centre.x() - shapes.ax[i], py = centre.y() - shapes.ay[i], pz = centre.z() - shapes.az[i];
      float t = (px * shapes.dx[i] + py * shapes.dy[i] + pz * shapes.dz[i]) * shapes.inverse_square[i];
      t = t < 0.0f ? 0.0f : t;
      t = t > 1.0f ? 1.0f : t;
      const float vx = px - t * shapes.dx[i], vy = py - t * shapes.dy[i], vz = pz - t * shapes.dz[i];
      from_centre_[s] = std::sqrt(vx * vx + vy * vy + vz * vz) - shapes.radius[i];
    }
    float least = k_infinite, other = k_infinite; // of the nearest unit, and of any other
    int unit = -1;
    for (int s = 0; s < shapes.count; ++s) {
      const float d = from_centre_[s];
      if (d < least) {
        if (shapes.unit[s] != unit) other = least;
        least = d;
        unit = shapes.unit[s];
      } else if (d < other && shapes.unit[s] != unit) {
        other = d;
      }
    }
    const float limit = (second ? other : least) + 2.0f * reach + 1e-5f; // rounding of metres in float is 1e-7
    chosen_.clear();
    for (int s = 0; s < shapes.count; ++s)
      if (!(from_centre_[s] > limit)) chosen_.push_back(s);
    return chosen_;
  }

private:
  std::vector<float> from_centre_;
  std::vector<int> chosen_;
};

void keep_nearest(const float* d, int shape, float* best, int* best_shape) {
  for (int k = 0; k < k_lanes; ++k) {
    const bool nearer = d[k] < best[k];
    best[k] = nearer ? d[k] : best[k];
    best_shape[k] = nearer ? shape : best_shape[k];
  }
}

void keep_second(const float* d, int shape, const PosedShapes& shapes, float* best, int* best_shape, float* next,
                 int* next_shape) {
  for (int k = 0; k < k_lanes; ++k) {
    const bool same_unit = best_shape[k] >= 0 && shapes.unit[best_shape[k]] == shapes.unit[shape];
    if (d[k] < best[k]) {
      if (!same_unit) next[k] = best[k], next_shape[k] = best_shape[k];
      best[k] = d[k];
      best_shape[k] = shape;
    } else if (d[k] < next[k] && !same_unit) {
      next[k] = d[k];
      next_shape[k] = shape;
    }
  }
}

} // namespace

void find_nearest(const PointBlocks& blocks, const PosedShapes& shapes, bool second, Nearest& nearest) {
  nearest.distance.assign(blocks.lane_count(), k_infinite);
  nearest.shape.assign(blocks.lane_count(), -1);
  nearest.second_distance.assign(second ? blocks.lane_count() : 0, k_infinite);
  nearest.second_shape.assign(second ? blocks.lane_count() : 0, -1);
  Candidates candidates;
  float d[k_lanes];
  for (int block = 0; block < blocks.block_count(); ++block) {
    const std::size_t lane = static_cast<std::size_t>(block) * k_lanes;
    const std::size_t first = static_cast<std::size_t>(blocks.pose[block]) * shapes.count;
    for (const int s :
         candidates.find(shapes, blocks.pose[block], blocks.centre[block], blocks.radius[block], second)) {
      distances(&blocks.x[lane], &blocks.y[lane], &blocks.z[lane], shapes, first + s, d);
      if (second)
        keep_second(d, s, shapes, &nearest.distance[lane], &nearest.shape[lane], &nearest.second_distance[lane],
                    &nearest.second_shape[lane]);
      else keep_nearest(d, s, &nearest.distance[lane], &nearest.shape[lane]);
    }
  }
}

} // namespace tutu::proxies::fit
