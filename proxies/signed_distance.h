// Closed-form signed distance of a point from each shape, in double.
#pragma once

#include "proxies/contact.h"
#include "proxies/shapes.h"

namespace tutu::proxies {

/// Nearer to the axis than this (m) is on the axis. Above the rounding of coordinates of some metres (1e-15), far below
/// any gap that matters.
inline constexpr double k_on_axis = 1e-12;
/// An axis is vertical when the sine of its angle to +Y is not above this: beyond it the direction nearest to +Y is
/// noise.
inline constexpr double k_vertical = 1e-12;

/// Distance to the segment minus the radius [Ericson 2005, Real-Time Collision Detection, 5.1.2].
/// A point on the axis has no unique normal: it gets normal_on_axis.
Contact signed_distance(const Vec3& point, const Capsule& capsule);

Contact signed_distance(const Vec3& point, const Plane& plane);

/// The normal of points on the axis: the unit vector perpendicular to the axis that is nearest to +Y
/// (+Y itself for a sphere, +X for a vertical axis), so a lone particle is pushed up, out of the limb.
Vec3 normal_on_axis(const Capsule& capsule);

} // namespace tutu::proxies
