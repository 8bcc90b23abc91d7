// How a point meets a collider.
#pragma once

#include "rig/math.h"

namespace tutu::proxies {

/// One point against one collider. The convention, as equations and tested so:
///   point = closest + distance * normal,   |normal| = 1,   distance < 0 inside.
/// `normal` points from the collider to the point (out of the solid, also when the point is inside).
struct Contact {
  double distance = 0.0;       ///< signed distance of the point from the surface, m
  Vec3 normal = Vec3::UnitY(); ///< unit
  Vec3 closest = Vec3::Zero(); ///< nearest point of the surface, world, m
};

} // namespace tutu::proxies
