#include "proxies/fit/detail/refine.h"

#include "proxies/distance/signed_distance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tutu::proxies::fit {
namespace {

constexpr double k_longest_step = 0.02;  // m, of any parameter
constexpr double k_least_radius = 0.005; // m
constexpr double k_enough = 1e-4;        // of the cost, that a step must gain to be followed by another
constexpr double k_first_damping = 1e-2, k_less = 0.3, k_more = 6.0, k_most_damping = 1e4;

void step(Unit& unit, const Hessian& hessian, const Row& gradient, double damping) {
  Hessian damped = hessian;
  const double trace = hessian.trace();
  if (!(trace > 0.0)) return;
  damped.diagonal() *= 1.0 + damping;
  damped.diagonal().array() += 1e-9 * trace; // parameters without effect stay
  Row move = -damped.ldlt().solve(gradient);
  const double longest = move.cwiseAbs().maxCoeff();
  if (!std::isfinite(longest)) return;
  if (longest > k_longest_step) move *= k_longest_step / longest;
  unit.a += move.head<3>();
  unit.b += move.segment<3>(3);
  unit.radius_a = std::max(k_least_radius, unit.radius_a + move[6]);
  unit.radius_b = unit.tapered ? std::max(k_least_radius, unit.radius_b + move[7]) : unit.radius_a;
  if (unit.kind == UnitKind::middle) unit.a.x() = unit.b.x() = 0.0;
  if (unit.kind == UnitKind::across) unit.b = mirrored(unit.a), unit.radius_b = unit.radius_a;
}

} // namespace

double cost_of(const Problem& problem, std::span<const Unit> units, PosedShapes& shapes, Nearest& nearest,
               bool second) {
  shapes.place(units, problem.motion);
  find_nearest(problem.blocks, shapes, second, nearest);
  double total = 0.0;
  for (std::size_t i = 0; i < nearest.distance.size(); ++i)
    total += static_cast<double>(problem.blocks.weight[i]) * problem.cost.of(static_cast<double>(nearest.distance[i]));
  for (const Unit& unit : units)
    total += problem.guard.cost(unit, problem.motion, problem.cost.guard, nullptr, nullptr);
  return total;
}

void accumulate(const Problem& problem, std::span<const Unit> units, const PosedShapes& shapes, const Nearest& nearest,
                std::vector<Hessian>& hessians, std::vector<Row>& gradients) {
  hessians.assign(units.size(), Hessian::Zero());
  gradients.assign(units.size(), Row::Zero());
  const PointBlocks& blocks = problem.blocks;
  for (std::size_t i = 0; i < nearest.distance.size(); ++i) {
    const double given = static_cast<double>(blocks.weight[i]);
    if (!(given > 0.0)) continue;
    const int s = nearest.shape[i], pose = blocks.pose[i / k_lanes], u = shapes.unit[s];
    const Unit& unit = units[u];
    const std::size_t frame = static_cast<std::size_t>(shapes.image[s]) * problem.motion.poses + pose;
    const Vec3 point(static_cast<double>(blocks.x[i]), static_cast<double>(blocks.y[i]),
                     static_cast<double>(blocks.z[i]));
    const Capsule& capsule = shapes.capsules[shapes.at(pose, s)];
    const double t = nearest_on_axis(point, capsule);
    const Vec3 away = point - capsule.a - t * (capsule.b - capsule.a);
    const double length = away.norm();
    if (!(length > 1e-9)) continue;
    const Vec3 n = away / length;
    const double e = length - capsule.radius_at(t), weight = given * (e > 0.0 ? problem.cost.under : problem.cost.over);
    Row row;
    row.head<3>() = -(1.0 - t) * (unit.frames_a[frame].leftCols<3>().transpose() * n);
    row.segment<3>(3) = -t * (unit.frames_b[frame].leftCols<3>().transpose() * n);
    row[6] = t - 1.0;
    row[7] = -t;
    if (shapes.image[s]) row[0] = -row[0], row[3] = -row[3];
    constrain(row, unit);
    hessians[u].noalias() += (weight * row) * row.transpose();
    gradients[u] += (weight * e) * row;
  }
  for (std::size_t u = 0; u < units.size(); ++u)
    problem.guard.cost(units[u], problem.motion, problem.cost.guard, &hessians[u], &gradients[u]);
}

double refine(const Problem& problem, std::vector<Unit>& units, int iterations) {
  PosedShapes shapes, tried_shapes;
  Nearest nearest, tried_nearest;
  double cost = cost_of(problem, units, shapes, nearest), damping = k_first_damping;
  std::vector<Hessian> hessians;
  std::vector<Row> gradients;
  bool moved = true;
  std::vector<Unit> tried;
  for (int iteration = 0; iteration < iterations && damping < k_most_damping; ++iteration) {
    if (moved) accumulate(problem, units, shapes, nearest, hessians, gradients);
    tried = units;
    for (std::size_t u = 0; u < tried.size(); ++u) step(tried[u], hessians[u], gradients[u], damping);
    const double cost_there = cost_of(problem, tried, tried_shapes, tried_nearest);
    moved = cost_there < cost;
    if (!moved) {
      damping *= k_more;
      continue;
    }
    const double gain = cost - cost_there;
    std::swap(units, tried);
    std::swap(shapes, tried_shapes);
    std::swap(nearest, tried_nearest);
    cost = cost_there;
    damping *= k_less;
    if (gain < k_enough * cost) break;
  }
  return cost;
}

} // namespace tutu::proxies::fit
