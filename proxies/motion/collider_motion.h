// How a collider gets from where a frame starts to where it ends, bounds of all it covers on the way, and what its
// surface does meanwhile.
#pragma once

#include "proxies/shapes.h"

namespace tutu::proxies {

/// The capsule at `s` in [0, 1] of the way: its middle on a straight line, its axis turned evenly along the shorter
/// arc, its length changing evenly, so that a limb that turns does not shorten. s = 0 and s = 1 give the ends' own
/// bits, and so does every s where the capsule does not move. A sphere's centre, and both ends where an axis has no
/// length or turns by half a turn (no arc is the shorter), go on straight lines. `end` has the radii of `start`.
Capsule capsule_at(const Capsule& start, const Capsule& end, double s);

/// How a capsule's axis moves on that way; the time unit is the whole way. With h = (b - a) / 2 at any moment,
///   middle' = middle,   h' = straight + stretch h / |h| + turn x h,   all four constant.
struct AxisMotion {
  Vec3 middle;          ///< m
  Vec3 straight;        ///< m; zero where the axis goes on an arc
  Vec3 turn;            ///< rad; zero where it goes straight
  double stretch = 0.0; ///< m; zero where it goes straight
};
AxisMotion axis_motion(const Capsule& start, const Capsule& end);

/// How far the farther end of the axis is from where it was, m: no point of the axis is farther.
double farthest_way(const Capsule& start, const Capsule& end);

/// A box around everything the capsule covers from start to end: that of both poses, grown by how far the arc bulges.
Box swept_box(const Capsule& start, const Capsule& end);

/// One still capsule around everything the capsule covers from start to end: about the mean of both poses, wider by
/// half the longer way an end goes and by the bulge of the arc.
Capsule swept_cover(const Capsule& start, const Capsule& end);

/// How far the material point of the capsule's surface that is nearest to `point` now has moved since `before`, m.
/// The ends tell how the axis moved and turned; `spin_since_before` (rotation vector, world, rad) adds the turn about
/// the axis, and for a sphere every turn. First order in the angle: wrong by radius * angle^2 / 2 at most, and terms of
/// third order.
Vec3 surface_motion(const Capsule& before, const Capsule& now, const Vec3& spin_since_before, const Vec3& point);

} // namespace tutu::proxies
