#include "proxies/fit/detail/model.h"

#include <limits>

namespace tutu::proxies::fit {
namespace {

constexpr float k_infinite = std::numeric_limits<float>::infinity();

/// The shapes that could be nearest to a point within `reach` of `centre` (or second nearest): distances from its
/// centre differ by at most `reach` from those of its points.
class Candidates {
public:
  std::span<const int> find(const PosedShapes& shapes, int pose, const Vec3f& centre, float reach, bool second) {
    from_centre_.resize(static_cast<std::size_t>(shapes.count) + k_lanes);
    distances_from_shapes(shapes.arrays(), shapes.at(pose, 0), shapes.count, centre.x(), centre.y(), centre.z(),
                          from_centre_.data());
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
  const ShapeArrays arrays = shapes.arrays();
  float d[k_lanes];
  for (int block = 0; block < blocks.block_count(); ++block) {
    const std::size_t lane = static_cast<std::size_t>(block) * k_lanes, first = shapes.at(blocks.pose[block], 0);
    const float *x = &blocks.x[lane], *y = &blocks.y[lane], *z = &blocks.z[lane];
    const std::span<const int> near =
        candidates.find(shapes, blocks.pose[block], blocks.centre[block], blocks.radius[block], second);
    if (!second) {
      nearest_of_block(arrays, first, near.data(), static_cast<int>(near.size()), x, y, z, &nearest.distance[lane],
                       &nearest.shape[lane]);
      continue;
    }
    for (const int s : near) {
      distances_from_shape(arrays, first + s, x, y, z, d);
      keep_second(d, s, shapes, &nearest.distance[lane], &nearest.shape[lane], &nearest.second_distance[lane],
                  &nearest.second_shape[lane]);
    }
  }
}

} // namespace tutu::proxies::fit
