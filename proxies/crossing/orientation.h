// On which side things are, without error: what rounding cannot turn round.
#pragma once

#include "rig/math.h"

#include <optional>

namespace tutu::proxies {

/// Coordinates that the predicates of this folder are exact for: 0, or of a size within these bounds (any unit).
/// Products of three differences then neither overflow nor lose bits below the least double.
inline constexpr double k_least_exact = 1e-80, k_largest_exact = 1e80;

/// The point as the predicates take it: coordinates below the least are 0. None where one is no number or too large.
std::optional<Vec3> exact_place(const Vec3& point);

/// The sign of (b - a) . ((c - a) x (d - a)), exactly: +1 where d is on the side to which the normal of the triangle
/// a b c points (counterclockwise seen from there), -1 on the other, 0 in its plane.
/// The formula in double decides where it is surely right, by the bound of [Shewchuk 1997, Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates, 4.3]: |error| <= (7 + 56 e) e P, e = 2^-53, P the
/// same formula of absolute values; elsewhere it is summed without rounding.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The sign of (b - a) . ((d - c) x (f - e)), as exactly: of three differences that need share no point.
int volume_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e, const Vec3& f);

/// The sign of one component of (b - a) x (d - c), exactly. `axis` is 0, 1 or 2.
int cross_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int axis);

} // namespace tutu::proxies
