// When cloth first touches a moving capsule within a step, and how far both may go in a step without asking.
#pragma once

#include "proxies/contact.h"
#include "proxies/distance/feature_contact.h"
#include "proxies/shapes.h"

#include <array>
#include <optional>

namespace tutu::proxies {

/// m. A gap of no more than this counts as touching: far above the rounding of coordinates of some metres (1e-15), far
/// below any thickness (1e-4).
inline constexpr double k_touch = 1e-6;

/// The first touch of a step. `time` in [0, 1] is the part of the step that has passed; `contact` is the one at that
/// time, with the cloth and the collider where they are then.
struct Impact {
  double time = 0.0;
  Contact contact;
};
struct FeatureImpact {
  double time = 0.0;
  FeatureContact contact;
};

/// The first time that a point on its straight way comes within `offset` (m, >= 0) of a capsule that goes from `start`
/// to `end` as capsule_at has it, arcs included (part of a frame's way is the same way, so a substep passes its own two
/// poses). Nothing where it does not. A point that is within from the start touches at time 0.
///
/// Never late: at no earlier time was the gap (distance - offset) 0. Early by at most k_touch: at `time` the gap is not
/// above it. A pass that leaves no more than k_touch may be told as a touch, one that leaves more is not.
/// Everything must be finite, and the radii and tapers of both poses equal.
std::optional<Impact> time_of_impact(const Vec3& from, const Vec3& to, const Capsule& start, const Capsule& end,
                                     double offset);

/// The same for an edge and a triangle whose vertices go on straight lines. Where the axis crosses it at the start, the
/// contact's normal is by winding (triangle_contact).
std::optional<FeatureImpact> time_of_impact(const std::array<Vec3, 2>& from, const std::array<Vec3, 2>& to,
                                            const Capsule& start, const Capsule& end, double offset);
std::optional<FeatureImpact> time_of_impact(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to,
                                            const Capsule& start, const Capsule& end, double offset);

/// How far cloth may move relative to a capsule in one step, m, so that the contact at the end of the step alone cannot
/// let it through: any motion below this is safe, this one is not. `radius`: of a cone the smaller. `offset` (m, >= 0):
/// how far from the surface the cloth was when the step began; 0 where no more is known than that it was outside.
///
/// Let R = radius + offset, p0 and p1 a point of the cloth at both ends of the step, q0 and q1 those of the axis' point
/// that is nearest to p1 at the end, and m the length of the relative motion w = (p1 - q1) - (p0 - q0). Suppose m < R.
/// The point was outside, so u = p0 - q0 has |u| >= R > m. Then
///   |p1 - q1| = |u + w| >= |u| - m > 0            it is not on the axis, and, on straight ways, never was;
///   (p1 - q1) . u = |u|^2 + w . u >= |u| (|u| - m) > 0
/// so the normal of the end pose, (p1 - q1) / |p1 - q1|, points to the side on which the axis saw the cloth before; by
/// less than asin(m / R) it differs from that direction. (Of a cone q is the centre of the nearest ball, whose radius
/// is at least the smaller one.) A push along it comes out on the side it came from. At m = R a point may lie on the
/// axis, from where every way out is as near; beyond, it is pushed out on the far side; from 2 R on it is not even seen
/// inside. For edges and triangles the same holds point by point.
///
/// The relative motion of any point of the cloth and any point of the axis is no longer than the longest of a vertex
/// relative to an end of the axis. An arc adds to what happens within the step, not to the end: the axis leaves its
/// straight lines by 1/8 of its half length times the angle squared.
double safe_motion(double radius, double offset);

} // namespace tutu::proxies
