#include "src/study/bench/threads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace tutu::app {
namespace {

std::vector<Thread> woven_threads(const cloth::Garment& garment) {
  const auto particle = [&](int row, int column) {
    const int i = row * garment.columns + column;
    return ThreadPoint{i, i, 0.0};
  };
  std::vector<Thread> threads;
  for (int row = 0; row < garment.rows; ++row) {
    Thread thread;
    for (int column = 0; column < garment.columns; ++column) thread.push_back(particle(row, column));
    if (garment.woven_shut) thread.push_back(thread.front());
    threads.push_back(std::move(thread));
  }
  for (int column = 0; column < garment.columns; ++column) {
    Thread thread;
    for (int row = 0; row < garment.rows; ++row) thread.push_back(particle(row, column));
    threads.push_back(std::move(thread));
  }
  return threads;
}

/// Where a plane cuts edges, and which of these points a triangle joins.
struct Cut {
  std::vector<ThreadPoint> points;
  std::vector<std::array<int, 2>> joints;  ///< two points, a triangle each
  std::vector<std::vector<int>> joints_at; ///< of each point
};

Cut cut_of(const cloth::Garment& garment, int axis, double level) {
  Cut cut;
  std::map<std::pair<int, int>, int> point_of; // by edge
  const auto height = [&](int i) { return garment.rest_positions[i][axis] - level; };
  for (const auto& t : garment.triangles) {
    std::vector<int> cut_edges;
    for (int k = 0; k < 3; ++k) {
      const auto [i, j] = std::minmax({static_cast<int>(t[k]), static_cast<int>(t[(k + 1) % 3])});
      // A corner in the plane counts as below it, so that a triangle is cut in two edges or none.
      if ((height(i) > 0.0) == (height(j) > 0.0)) continue;
      const auto [found, is_new] = point_of.try_emplace({i, j}, static_cast<int>(cut.points.size()));
      if (is_new) cut.points.push_back({i, j, height(i) / (height(i) - height(j))});
      cut_edges.push_back(found->second);
    }
    if (cut_edges.size() == 2) cut.joints.push_back({cut_edges[0], cut_edges[1]});
  }
  cut.joints_at.resize(cut.points.size());
  for (std::size_t k = 0; k < cut.joints.size(); ++k)
    for (const int point : cut.joints[k]) cut.joints_at[point].push_back(static_cast<int>(k));
  return cut;
}

/// Walks on from a point until the line ends, branches or comes back.
Thread line_from(const Cut& cut, int point, int joint, std::vector<bool>& taken) {
  Thread line = {cut.points[point]};
  for (int next = joint; next >= 0;) {
    taken[next] = true;
    const auto& ends = cut.joints[next];
    point = ends[0] == point ? ends[1] : ends[0];
    line.push_back(cut.points[point]);
    next = -1;
    if (cut.joints_at[point].size() != 2) break;
    for (const int on : cut.joints_at[point])
      if (!taken[on]) next = on;
  }
  return line;
}

void add_lines(const Cut& cut, std::vector<Thread>& threads) {
  std::vector<bool> taken(cut.joints.size());
  for (const bool closed : {false, true}) // what has no end is left for last
    for (std::size_t point = 0; point < cut.points.size(); ++point)
      if (closed || cut.joints_at[point].size() != 2)
        for (const int joint : cut.joints_at[point])
          if (!taken[joint]) threads.push_back(line_from(cut, static_cast<int>(point), joint, taken));
}

double mean_edge(const cloth::Garment& garment) {
  double sum = 0.0;
  for (const auto& t : garment.triangles)
    for (int k = 0; k < 3; ++k) sum += (garment.rest_positions[t[k]] - garment.rest_positions[t[(k + 1) % 3]]).norm();
  return sum / (3.0 * static_cast<double>(garment.triangles.size()));
}

std::vector<Thread> level_lines(const cloth::Garment& garment) {
  std::vector<Thread> threads;
  if (garment.triangles.empty()) return threads;
  const double edge = mean_edge(garment);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : garment.rest_positions) box.extend(p);
  for (int axis = 0; axis < 3; ++axis) {
    // No more than particles, where pieces of a garment lie far apart.
    const int lines =
        static_cast<int>(std::min(std::floor(box.sizes()[axis] / edge), static_cast<double>(garment.particle_count())));
    for (int k = 0; k < lines; ++k)
      add_lines(cut_of(garment, axis, std::lerp(box.min()[axis], box.max()[axis], (k + 0.5) / lines)), threads);
  }
  return threads;
}

} // namespace

std::vector<Thread> threads_of(const cloth::Garment& garment) {
  return garment.rows > 0 ? woven_threads(garment) : level_lines(garment);
}

} // namespace tutu::app
