#include "cloth/contact/spatial_hash.h"

#include <algorithm>
#include <bit>

namespace tutu::cloth {

void SpatialHash::build(std::span<const Vec3> points, double reach) {
  entries_.resize(points.size());
  buckets_.resize(points.size());
  const auto buckets = static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(4, 2 * points.size())));
  mask_ = buckets - 1;
  begin_.assign(buckets + 1, 0);
  if (points.empty()) return;

  Vec3 high = points.front();
  low_ = high;
  for (const Vec3& p : points) {
    low_ = low_.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  constexpr double k_most_cells = 1 << 20; // along an axis: cells fit into an int whatever the points are
  per_cell_ = 1.0 / std::max(reach * (1.0 + 1e-9), (high - low_).maxCoeff() / k_most_cells);

  for (std::size_t i = 0; i < points.size(); ++i) {
    const Cell cell = cell_of(points[i]);
    buckets_[i] = bucket_of(cell.x, cell.y, cell.z);
    ++begin_[buckets_[i]];
  }
  int sum = 0;
  for (int& count : begin_) { // to where each bucket ends
    sum += count;
    count = sum;
  }
  for (std::size_t i = points.size(); i-- > 0;) { // from the back, so that points of a bucket rise
    const Cell cell = cell_of(points[i]);
    entries_[--begin_[buckets_[i]]] = {points[i], static_cast<int>(i), cell.x, cell.y, cell.z};
  }
}

} // namespace tutu::cloth
