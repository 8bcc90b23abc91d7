// Levenberg-Marquardt on the parameters of all units at once.
#pragma once

#include "proxies/fit/detail/guard.h"

#include <functional>

namespace tutu::proxies::fit {

/// What a fit minimises: sum over points of weight * (under or over) * e^2, e = signed distance of the point from the
/// nearest shape (> 0: the skin sticks out), plus the guard.
struct Cost {
  double under = 1.0, over = 1.0;
  Guard::Strength guard;

  double of(double e) const { return (e > 0.0 ? under : over) * e * e; }
};

struct Problem {
  const PointBlocks& blocks;
  const BodyMotion& motion;
  const Guard& guard;
  Cost cost;
};

/// The cost of units as they are; `nearest` receives what it was found from.
double cost_of(const Problem& problem, std::span<const Unit> units, PosedShapes& shapes, Nearest& nearest,
               bool second = false);

/// Improves the units by up to `iterations` steps; the cost never rises. Stops early where steps gain less than 1e-4 of
/// it. Each point pulls at the shape it is nearest to: the Hessian is one block a unit, with
///   de/da = -(1-t) A^T n, de/db = -t B^T n, de/dr_a = -(1-t), de/dr_b = -t,
/// n the unit vector from the nearest ball's centre to the point, t its place on the axis, A and B the frames of the
/// ends. t is where e is least, so that its own change does not count.
double refine(const Problem& problem, std::vector<Unit>& units, int iterations);

/// The Gauss-Newton terms of every unit at the present nearest shapes. Exposed for the tests of derivatives.
void accumulate(const Problem& problem, std::span<const Unit> units, const PosedShapes& shapes, const Nearest& nearest,
                std::vector<Hessian>& hessians, std::vector<Row>& gradients);

} // namespace tutu::proxies::fit
