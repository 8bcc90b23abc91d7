// The solids that stand in for the body. World space, m.
#pragma once

#include "rig/math.h"

#include <algorithm>

namespace tutu::proxies {

/// The balls about all points of the segment a..b, their radius growing evenly by `taper` from `radius` at a; where
/// |taper| < |b - a| that is both end balls and the cone that touches them, elsewhere the larger ball alone. With
/// taper == 0 all points within `radius` of the segment, with a == b a sphere (then taper == 0), so one type serves all
/// in the hot path.
struct Capsule {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double radius = 0.0; ///< at a, > 0
  double taper = 0.0;  ///< m, added by b: radius + taper > 0

  double radius_at(double t) const { return radius + t * taper; } ///< t in [0, 1] of the axis
  double widest() const { return std::max(radius, radius + taper); }
  double narrowest() const { return std::min(radius, radius + taper); }
};

/// A box along the axes of the world, m.
using Box = Eigen::AlignedBox3d;

/// The solid half space normal . x <= offset; `normal` is unit and points out.
struct Plane {
  Vec3 normal = Vec3::UnitY();
  double offset = 0.0;
};

} // namespace tutu::proxies
