#include "proxies/fit/detail/split.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

namespace tutu::proxies::fit {
namespace {

constexpr int k_iterations = 8;
constexpr std::size_t k_least_points = 8; // of the skin, under a new capsule

bool on_middle(const Unit& unit) { return unit.kind == UnitKind::middle || unit.kind == UnitKind::across; }

using Points = std::vector<UnitPoint>;

/// Both halves of the points by their coordinate along a direction, cut at the weighted median.
std::array<Points, 2> halves(const Points& points, const Vec3& direction) {
  std::vector<std::pair<double, std::size_t>> order;
  double total = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    order.emplace_back(points[i].rest.dot(direction), i);
    total += points[i].weight;
  }
  std::sort(order.begin(), order.end());
  std::array<Points, 2> parts;
  double reached = 0.0;
  for (const auto& [at, i] : order) {
    parts[reached < 0.5 * total ? 0 : 1].push_back(points[i]);
    reached += points[i].weight;
  }
  return parts;
}

/// The points about the one whose neighbourhood costs most: a fifth of them.
Points worst_cluster(const Points& points) {
  const auto worst = std::max_element(points.begin(), points.end(),
                                      [](const UnitPoint& a, const UnitPoint& b) { return a.cost < b.cost; });
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i) order.emplace_back((points[i].rest - worst->rest).squaredNorm(), i);
  std::sort(order.begin(), order.end());
  Points cluster;
  for (std::size_t i = 0; i < std::max<std::size_t>(points.size() / 5, k_least_points) && i < order.size(); ++i)
    cluster.push_back(points[order[i].second]);
  return cluster;
}

std::vector<Vec3> directions(const Points& points, const Unit& unit) {
  Vec3 mean = Vec3::Zero();
  for (const UnitPoint& p : points) mean += p.rest / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const UnitPoint& p : points) covariance += (p.rest - mean) * (p.rest - mean).transpose();
  std::vector<Vec3> result;
  if (on_middle(unit)) {
    covariance.row(0).setZero();
    covariance.col(0).setZero();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    for (int k : {2, 1}) result.push_back(solver.eigenvectors().col(k));
    return result;
  }
  const Vec3 axis = unit.b - unit.a;
  if (axis.norm() > 1e-3) result.push_back(axis.normalized());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  for (int k : {2, 1, 0}) {
    const Vec3 direction = solver.eigenvectors().col(k);
    if (result.empty() || std::abs(direction.dot(result.front())) < 0.9) result.push_back(direction);
  }
  return result;
}

class Splitter {
public:
  Splitter(const Problem& problem, const Unit& unit, const Ownership& own)
      : problem_{own.blocks, problem.motion, problem.guard, problem.cost}, unit_(unit), own_(own) {}

  std::array<Split, 3> run() {
    if (own_.points.size() < 2 * k_least_points) return best_;
    for (const Vec3& direction : directions(own_.points, unit_)) {
      const auto parts = halves(own_.points, direction);
      if (on_middle(unit_)) {
        try_units({through(parts[0], UnitKind::middle), through(parts[1], UnitKind::middle)});
        try_units({through(parts[0], UnitKind::across), through(parts[1], UnitKind::across)});
        try_units({through(parts[0], UnitKind::middle), through(parts[1], UnitKind::pair)});
        try_units({through(parts[0], UnitKind::pair), through(parts[1], UnitKind::middle)});
      } else {
        try_units({through(parts[0], unit_.kind), through(parts[1], unit_.kind)});
      }
    }
    const Points worst = worst_cluster(own_.points);
    if (on_middle(unit_)) {
      const auto sides = halves(own_.points, Vec3::UnitX()); // folded: near the middle, and away from it
      try_units({through(own_.points, UnitKind::pair)});
      try_units({through(sides[0], UnitKind::middle), through(sides[1], UnitKind::pair)});
      try_units({through(own_.points, unit_.kind == UnitKind::middle ? UnitKind::across : UnitKind::middle)});
      try_units({unit_, through(worst, UnitKind::middle)});
      try_units({unit_, through(worst, UnitKind::pair)});
    } else {
      try_units({unit_, through(worst, unit_.kind)});
    }
    return best_;
  }

private:
  Unit through(const Points& points, UnitKind kind) const {
    return capsule_through(points, kind, unit_.tapered, problem_.motion);
  }

  void try_units(std::vector<Unit> units) {
    int shapes = 0;
    for (const Unit& unit : units) shapes += unit.shapes();
    const int added = shapes - unit_.shapes();
    if (added < 0 || added > 2) return;
    const double gain = own_.cost - refine(problem_, units, k_iterations);
    if (!(gain > best_[added].gain)) return;
    best_[added] = {std::move(units), added, gain};
  }

  Problem problem_;
  const Unit& unit_;
  const Ownership& own_;
  std::array<Split, 3> best_;
};

} // namespace

Ownership owned_by(int unit, const Problem& problem, const FitPoints& points, std::span<const Unit> units,
                   const PosedShapes& shapes, const Nearest& nearest, int most_lanes) {
  const PointBlocks& all = problem.blocks;
  std::vector<std::size_t> lanes;
  for (std::size_t i = 0; i < all.lane_count(); ++i)
    if (all.weight[i] > 0.0f && shapes.unit[nearest.shape[i]] == unit) lanes.push_back(i);
  Ownership own;
  std::map<std::pair<int, bool>, UnitPoint> seen;
  for (const std::size_t i : lanes) {
    const int point = all.point[i];
    const bool fold = on_middle(units[unit]) ? points.skin[point].rest.x() < 0.0 : shapes.image[nearest.shape[i]] != 0;
    auto [entry, is_new] = seen.try_emplace({point, fold});
    if (is_new) entry->second = unit_point(points.skin[point], fold, problem.motion);
    const double weight = static_cast<double>(all.weight[i]);
    entry->second.weight += weight;
    entry->second.cost += weight * problem.cost.of(static_cast<double>(nearest.distance[i]));
  }
  for (const auto& [key, point] : seen) own.points.push_back(point);

  const std::size_t stride = std::max<std::size_t>(1, lanes.size() / static_cast<std::size_t>(most_lanes));
  std::vector<Vec3f> at;
  std::vector<float> weights;
  std::vector<int> of;
  int pose = 0;
  const auto flush = [&] {
    if (!at.empty()) own.blocks.add(pose, at, weights, of);
    at.clear();
    weights.clear();
    of.clear();
  };
  for (std::size_t k = 0; k < lanes.size(); k += stride) {
    const std::size_t i = lanes[k];
    const int in = all.pose[i / k_lanes];
    if (in != pose || at.size() == k_lanes) flush();
    pose = in;
    at.emplace_back(all.x[i], all.y[i], all.z[i]);
    weights.push_back(all.weight[i] * static_cast<float>(stride));
    of.push_back(all.point[i]);
    own.cost += static_cast<double>(weights.back()) * problem.cost.of(static_cast<double>(nearest.distance[i]));
  }
  flush();
  own.cost += problem.guard.cost(units[unit], problem.motion, problem.cost.guard, nullptr, nullptr);
  return own;
}

std::array<Split, 3> best_splits(const Problem& problem, const Unit& unit, const Ownership& own) {
  return Splitter(problem, unit, own).run();
}

} // namespace tutu::proxies::fit
