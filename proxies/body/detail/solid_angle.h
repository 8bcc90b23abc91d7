// How large a triangle looks from a point.
#pragma once

#include "rig/math.h"

#include <cmath>

namespace tutu::proxies {

/// Tangent of half the solid angle of triangle a b c from `point`, as (y, x) of atan2. Both are scaled by the product
/// of the three distances. Positive where the triangle runs clockwise as seen from the point, that is, where the point
/// is behind it. [van Oosterom and Strackee 1983]
struct HalfSolidAngle {
  double y, x;
};

inline HalfSolidAngle half_solid_angle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = a - point, v = b - point, w = c - point;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  return {u.dot(v.cross(w)), lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv};
}

/// Solid angle over 4 pi, in [-1/2, 1/2]: what the triangle adds to the winding number. 0 from one of its corners.
inline double winding_of(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const HalfSolidAngle half = half_solid_angle(point, a, b, c);
  return std::atan2(half.y, half.x) * (0.5 / M_PI);
}

} // namespace tutu::proxies
