// Which points lie near each other: cubes of space, hashed, their points side by side.
#pragma once

#include "rig/math.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace tutu::cloth {

/// Points sorted by the cube they lie in (a counting sort). Cubes that follow each other along x have buckets that do,
/// so that three cubes are one run of points. Memory is kept from build to build.
class SpatialHash {
public:
  /// Of finite points; `reach` > 0, m.
  void build(std::span<const Vec3> points, double reach);

  /// Calls visit(i, j, squared distance) once for every two points of build() that are not farther than `reach` from
  /// each other on any axis, and for some others; i is not always the smaller. In no order that means anything, but in
  /// the same on every run.
  template <class Visit> void for_each_pair(const Visit& visit) const {
    for (int e = 0; e < static_cast<int>(entries_.size()); ++e) {
      const Entry& entry = entries_[e];
      const auto visit_run = [&](int first, int last, int y, int z) {
        for (int f = first; f < last; ++f)
          if (entries_[f].y == y && entries_[f].z == z)
            visit(entry.index, entries_[f].index, (entries_[f].point - entry.point).squaredNorm());
      };
      // Its own cube, of which the points behind it are left, and the next; then the four rows of cubes that are ahead.
      const std::uint32_t own = bucket_of(entry.x, entry.y, entry.z), next = (own + 1) & mask_;
      visit_run(e + 1, begin_[own + 1], entry.y, entry.z);
      visit_run(begin_[next], begin_[next + 1], entry.y, entry.z);
      constexpr int k_ahead[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
      for (const auto& [dy, dz] : k_ahead) {
        const int y = entry.y + dy, z = entry.z + dz;
        const std::uint32_t first = bucket_of(entry.x - 1, y, z);
        if (first + 3 <= mask_ + 1) {
          visit_run(begin_[first], begin_[first + 3], y, z);
          continue;
        }
        for (std::uint32_t k = 0; k < 3; ++k) { // around the table's end
          const std::uint32_t bucket = (first + k) & mask_;
          visit_run(begin_[bucket], begin_[bucket + 1], y, z);
        }
      }
    }
  }

private:
  struct Cell {
    int x = 0, y = 0, z = 0;
  };
  struct Entry {
    Vec3 point;
    int index = 0;
    int x = 0, y = 0, z = 0; ///< of its cube: tells it from others in the same bucket
  };

  Cell cell_of(const Vec3& p) const {
    return {static_cast<int>(std::floor((p.x() - low_.x()) * per_cell_)),
            static_cast<int>(std::floor((p.y() - low_.y()) * per_cell_)),
            static_cast<int>(std::floor((p.z() - low_.z()) * per_cell_))};
  }
  std::uint32_t bucket_of(int x, int y, int z) const {
    const std::uint32_t row = static_cast<std::uint32_t>(y) * 0x9E3779B1u + static_cast<std::uint32_t>(z) * 0x85EBCA77u;
    return (static_cast<std::uint32_t>(x) + (row >> 8)) & mask_;
  }

  Vec3 low_ = Vec3::Zero(); ///< m, of all points
  double per_cell_ = 1.0;   ///< 1/m
  std::uint32_t mask_ = 3;  ///< buckets - 1; buckets are a power of two
  std::vector<int> begin_;  ///< of each bucket in entries_; buckets + 1
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> buckets_; ///< of each point
};

} // namespace tutu::cloth
