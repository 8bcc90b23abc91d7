// Whether a segment goes through a triangle, exactly; what touches is told apart by one rule.
#pragma once

#include "rig/math.h"

namespace tutu::proxies {

/// To which side an infinitely small step is taken where things touch.
enum class Beside { before = -1, behind = 1 };

/// +1 where the segment p q goes through the triangle t0 t1 t2 along its normal (from where it is seen clockwise), -1
/// where it goes against it, 0 where it does not go through.
///
/// No answer rests on rounding, and none is "just touching": the segment is taken to stand beside its place by
/// (e, e^2, e^3) times +1 (behind) or -1 (before), e > 0 smaller than any number [after the simulation of simplicity,
/// Edelsbrunner and Muecke 1990; one step for all corners, so that what is flush stays apart]. Then nothing touches
/// anything, and hence
///  - a segment through an edge that two triangles share goes through one of them, through a corner of a closed fan
///    through one of the fan;
///  - of a path of segments whose joint lies in the triangle one goes through, or both or none where it turns back;
///  - a segment in the triangle's plane, and a triangle without area, are never gone through.
/// Edges of surface A against triangles of B from `behind`, and B's against A's from `before`, are one and the same
/// picture: A as a whole beside its place.
/// Coordinates as in orientation.h.
int passage_through(const Vec3& p, const Vec3& q, const Vec3& t0, const Vec3& t1, const Vec3& t2,
                    Beside beside = Beside::behind);

} // namespace tutu::proxies
