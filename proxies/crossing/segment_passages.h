// How often two segments pass through each other while their ends move, exactly: no moment is ever computed.
#pragma once

#include "rig/math.h"

namespace tutu::proxies {

/// An end that moves on a straight line, evenly.
struct MovingPoint {
  Vec3 from, to;
};

/// The net number of times that the segments p q and a b pass through each other: +1 for each time that
/// (q - p) . ((a - p) x (b - p)) rises through 0, -1 for each time that it falls.
///
/// A passage is a root of F(s, r, t) = p + s (q - p) - (a + r (b - a)) in the unit cube of both shares and the time,
/// and the net number is the degree of F there, which the image of the cube's surface alone decides: how often it goes
/// round 0 [as Brochu, Edwards and Bridson 2012, Efficient Geometrically Exact Continuous Collision Detection, have its
/// parity]. Each of the six sides is taken as two triangles of its four corners, and a ray from 0 counted through them
/// by exact signs. Hence, without a tolerance,
///  - what several pairs share counts once: a joint of a path of segments, a moment between two motions; all that is
///    counted along a path over many motions rests on the ends of both paths alone;
///  - what moves together in one way never passes;
///  - segments that touch are told apart as if a b stood beside its place by (e, e^2, e^3), e > 0 smaller than any
///    number, here and in passage_through() behind it;
///  - two triangles are not the curved side that four corners span. They differ where an end of the one segment passes
///    within the other's twist of it: nothing between the joints of a path, for there both neighbours differ alike.
/// Coordinates as in orientation.h.
int net_passages(const MovingPoint& p, const MovingPoint& q, const MovingPoint& a, const MovingPoint& b);

} // namespace tutu::proxies
