// Closed-form signed distance of a point from each shape, in double.
#pragma once

#include "proxies/contact.h"
#include "proxies/distance/closed_forms.h"
#include "proxies/shapes.h"

namespace tutu::proxies {

/// Nearer to the axis than this (m) is on the axis. Above the rounding of coordinates of some metres (1e-15), far below
/// any gap that matters.
inline constexpr double k_on_axis = 1e-12;
/// An axis is vertical when the sine of its angle to +Y is not above this: beyond it the direction nearest to +Y is
/// noise.
inline constexpr double k_vertical = 1e-12;

/// Sine of a capsule's cone: a normal of its side leans by that from perpendicular to the axis, towards the thinner
/// end,
///   n . (b - a) = -taper,
/// since there |p - c(t)| - r(t) is least along the axis, and rises the same way on both sides of c(t).
/// 0 without taper; +-1 where the larger end ball is all there is.
double cone_sine(const Capsule& capsule);

/// Distance to the nearest ball's centre minus its radius: exact, inside and out, for the union of all balls is convex.
/// A point on the axis has no unique normal: it gets normal_on_axis.
Contact signed_distance(const Vec3& point, const Capsule& capsule);

Contact signed_distance(const Vec3& point, const Plane& plane);

/// The normal of points on the axis: of those the side has, the one nearest to +Y (+Y itself for a sphere, the one
/// towards +X for a vertical axis), so a lone particle is pushed up, out of the limb.
Vec3 normal_on_axis(const Capsule& capsule);

} // namespace tutu::proxies
