// The solids that stand in for the body. World space, m.
#pragma once

#include "rig/math.h"

namespace tutu::proxies {

/// All points within `radius` of the segment a..b. With a == b it is a sphere, so one type serves both in the hot path.
struct Capsule {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double radius = 0.0; ///< > 0
};

/// A box along the axes of the world, m.
using Box = Eigen::AlignedBox3d;

/// The solid half space normal . x <= offset; `normal` is unit and points out.
struct Plane {
  Vec3 normal = Vec3::UnitY();
  double offset = 0.0;
};

} // namespace tutu::proxies
