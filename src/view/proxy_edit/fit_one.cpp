#include "src/view/proxy_edit/fit_one.h"

#include "proxies/distance/capsule_union.h"
#include "proxies/distance/signed_distance.h"
#include "src/view/proxy_edit/proxy_handles.h"

#include <Eigen/Cholesky>
#include <limits>

namespace tutu::app {
namespace {

using proxies::Capsule;
using Row = Eigen::Matrix<double, 8, 1>; // a, b, radius at a, radius at b
using Square = Eigen::Matrix<double, 8, 8>;

/// What the kind of the shape leaves free: rows that are one with another are added to it and left at 0.
struct Freedom {
  bool sphere, even; ///< both ends are one; both radii are

  void constrain(Row& row) const {
    if (sphere) {
      row.head<3>() += Vec3(row.segment<3>(3));
      row.segment<3>(3).setZero();
    }
    if (sphere || even) {
      row[6] += row[7];
      row[7] = 0.0;
    }
  }
  Capsule moved(const Capsule& shape, const Row& step) const {
    Capsule result = shape;
    result.a += Vec3(step.head<3>());
    result.b = sphere ? result.a : Vec3(shape.b + Vec3(step.segment<3>(3)));
    result.radius = std::max(k_least_radius, shape.radius + step[6]);
    if (sphere || even) return result;
    result.taper = std::max(k_least_radius, shape.radius_at(1.0) + step[7]) - result.radius;
    return result;
  }
};

/// The skin, and how far it is from all other shapes.
struct Task {
  std::span<const SkinSpot> spots;
  std::vector<double> others; ///< [spot]
};

double cost_of(const Task& task, const Capsule& shape) {
  proxies::CapsuleUnion own;
  own.assign({&shape, 1});
  double cost = 0.0;
  for (std::size_t s = 0; s < task.spots.size(); ++s) {
    const double d = std::min(task.others[s], own.distance(task.spots[s].place));
    cost += task.spots[s].area * d * d;
  }
  return cost;
}

/// Gauss-Newton terms of the skin that the shape is nearest to.
void accumulate(const Task& task, const Capsule& shape, const Freedom& freedom, Square& hessian, Row& gradient) {
  hessian.setZero();
  gradient.setZero();
  for (std::size_t s = 0; s < task.spots.size(); ++s) {
    const Vec3& p = task.spots[s].place;
    const double t = proxies::nearest_on_axis(p, shape);
    const Vec3 away = p - shape.a - t * (shape.b - shape.a);
    const double length = away.norm(), d = length - shape.radius_at(t);
    if (!(d < task.others[s]) || !(length > proxies::k_on_axis)) continue;
    const Vec3 n = away / length;
    Row row;
    row << -(1.0 - t) * n, -t * n, -(1.0 - t), -t;
    freedom.constrain(row);
    hessian += task.spots[s].area * row * row.transpose();
    gradient += task.spots[s].area * d * row;
  }
}

} // namespace

double skin_cost(std::span<const SkinSpot> spots, std::span<const Capsule> shapes) {
  proxies::CapsuleUnion all;
  all.assign(shapes);
  double cost = 0.0;
  for (const SkinSpot& spot : spots) {
    const double d = all.distance(spot.place);
    cost += spot.area * d * d;
  }
  return cost;
}

Capsule fit_one(std::span<const SkinSpot> spots, std::span<const Capsule> shapes, int one, bool sphere) {
  constexpr int k_iterations = 200;
  constexpr double k_gain = 1e-9; // share of the cost: a step that gains less ends it
  constexpr double k_first = 1e-3, k_most = 1e9, k_up = 8, k_down = 4; // damping, of the Hessian's diagonal
  Task task{spots, std::vector<double>(spots.size(), std::numeric_limits<double>::infinity())};
  proxies::CapsuleUnion all;
  all.assign(shapes);
  for (std::size_t s = 0; s < spots.size(); ++s)
    task.others[s] = all.distance_without(spots[s].place, static_cast<std::size_t>(one));
  Capsule shape = shapes[one];
  const Freedom freedom{sphere, shape.taper == 0.0};
  double cost = cost_of(task, shape), damping = k_first;
  Square hessian;
  Row gradient;
  for (int k = 0; k < k_iterations && damping < k_most;) {
    accumulate(task, shape, freedom, hessian, gradient);
    const double floor = 1e-12 * hessian.trace(); // what no skin tells of stays
    if (!(floor > 0.0)) break;
    for (; k < k_iterations && damping < k_most; damping *= k_up) {
      ++k;
      Square damped = hessian;
      damped.diagonal() += Row(damping * hessian.diagonal().array() + floor);
      const Capsule next = freedom.moved(shape, -damped.ldlt().solve(gradient));
      const double next_cost = cost_of(task, next);
      if (!(next_cost < cost)) continue;
      const bool done = cost - next_cost < k_gain * cost;
      shape = next;
      cost = next_cost;
      damping /= k_down;
      if (done) return shape;
      break;
    }
  }
  return shape;
}

} // namespace tutu::app
