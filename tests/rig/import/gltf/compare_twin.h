// What a reader makes of a glTF file, held against the twin.
#pragma once

#include "tests/rig/import/gltf/gltf_twin.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace tutu::test {

inline constexpr double k_close = 1e-5; // of the height
inline constexpr int k_times = 10;      // a clip

inline double height_of(const std::vector<Vec3>& points) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& p : points) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  return high - low;
}

inline double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!a[i].allFinite() || !b[i].allFinite()) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, (a[i] - b[i]).norm());
  }
  return largest;
}

/// The same of triangles in any order, which may begin at any of their corners: some codecs turn and sort them.
inline double farthest_triangle(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  if (from.size() != to.size()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t i = 0; i < from.size(); i += 3) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < to.size(); j += 3)
      for (std::size_t turn = 0; turn < 3; ++turn) {
        double distance = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
          distance = std::max(distance, (from[i + k] - to[j + (k + turn) % 3]).norm());
        nearest = std::min(nearest, distance);
      }
    largest = std::max(largest, nearest);
  }
  return largest;
}

/// The greatest distance from a point of either to the nearest of the other: for what is welded, sorted or turned.
inline double farthest_point(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const auto one_way = [](const std::vector<Vec3>& from, std::vector<Vec3> to) {
    std::sort(to.begin(), to.end(), [](const Vec3& p, const Vec3& q) { return p.x() < q.x(); });
    double largest = 0.0;
    for (const Vec3& p : from) {
      const auto middle =
          std::lower_bound(to.begin(), to.end(), p.x(), [](const Vec3& q, double x) { return q.x() < x; });
      double nearest = std::numeric_limits<double>::infinity();
      for (auto q = middle; q != to.end() && q->x() - p.x() < nearest; ++q)
        nearest = std::min(nearest, (*q - p).norm());
      for (auto q = middle; q != to.begin() && p.x() - std::prev(q)->x() < nearest; --q)
        nearest = std::min(nearest, (*std::prev(q) - p).norm());
      largest = std::max(largest, nearest);
    }
    return largest;
  };
  return std::max(one_way(a, b), one_way(b, a));
}

/// What a reader makes of a file: corners at a time of an animation.
using Reading = std::function<std::vector<Vec3>(int animation, double time)>;
using Distance = std::function<double(const std::vector<Vec3>&, const std::vector<Vec3>&)>;

/// The greatest difference between reading and twin, at rest and at ten times of each animation; of the height.
inline double difference(GltfTwin& twin, const Reading& reading, const Distance& distance = farthest) {
  const std::vector<Vec3> rest = twin.corners(-1, 0.0);
  const double height = height_of(rest);
  EXPECT_GT(height, 0.0);
  double largest = distance(rest, reading(-1, 0.0));
  for (std::size_t a = 0; a < twin.animations(); ++a)
    for (int k = 0; k < k_times; ++k) {
      const double time = twin.end_of(a) * (k + 0.37) / k_times;
      largest =
          std::max(largest, distance(twin.corners(static_cast<int>(a), time), reading(static_cast<int>(a), time)));
    }
  return largest / height;
}

} // namespace tutu::test
