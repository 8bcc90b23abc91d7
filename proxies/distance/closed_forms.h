// The closed forms of proxies/distance/closed_forms_inl.h in double, one number at a time.
#pragma once

#include "proxies/shapes.h"

#include <algorithm>
#include <cmath>

namespace tutu::proxies {

struct PlainArithmetic {
  using Real = double;
  using Vector = Vec3;
  /// m2 or m4: what is not above it counts as 0, and one over its root is finite.
  static constexpr double k_least_square = 1e-100;
  static constexpr double k_steep = 0.0, k_parallel = 1e-12; ///< shares; ClosedForms
  static constexpr bool k_one_lane = true;

  static double set(double x) { return x; }
  static double min(double x, double y) { return std::min(x, y); }
  static double max(double x, double y) { return std::max(x, y); }
  static double abs(double x) { return std::abs(x); }
  static double sqrt(double x) { return std::sqrt(x); }
  static double select(bool which, double x, double y) { return which ? x : y; }
  static double dot(const Vec3& v, const Vec3& w) { return v.dot(w); }
  static Vec3 cross(const Vec3& v, const Vec3& w) { return v.cross(w); }
  static double length(const Vec3& v) { return v.norm(); }
  static Vec3 plus_times(const Vec3& v, double s, const Vec3& w) { return v + s * w; }
  static Vec3 minus_times(const Vec3& v, double s, const Vec3& w) { return v - s * w; }
};

#include "proxies/distance/closed_forms_inl.h"

using PlainForms = ClosedForms<PlainArithmetic>;
using PlainCone = RoundCone<PlainArithmetic>;

/// Whether one end ball of a capsule is all there is: a sphere, or one end holds the other.
inline bool is_one_ball(const Capsule& capsule) {
  return !((capsule.b - capsule.a).squaredNorm() - capsule.taper * capsule.taper > PlainArithmetic::k_least_square);
}

/// The end ball that is all there is of it.
inline Capsule wide_end(const Capsule& capsule) {
  const Vec3& centre = capsule.taper > 0.0 ? capsule.b : capsule.a;
  return {centre, centre, capsule.widest(), 0.0};
}

/// Of a capsule that is not one ball.
inline PlainCone two_ball_cone(const Capsule& capsule) {
  const Vec3 axis = capsule.b - capsule.a;
  const double squared = axis.squaredNorm(), taper = capsule.taper;
  const double lean = taper == 0.0 ? 0.0 : taper / std::sqrt(squared * (squared - taper * taper));
  return {capsule.a, axis, 1.0 / squared, capsule.radius, taper, lean};
}

inline PlainCone round_cone(const Capsule& capsule) {
  if (!is_one_ball(capsule)) return two_ball_cone(capsule);
  const Capsule ball = wide_end(capsule);
  return {ball.a, Vec3::Zero(), 0.0, ball.radius, 0.0, 0.0};
}

/// The place of the ball that is nearest to a point `from_a` from the cone's a.
inline double nearest_on_axis(const PlainCone& cone, const Vec3& from_a) {
  return cone.taper == 0.0 ? PlainForms::nearest_on_axis<false>(cone, from_a)
                           : PlainForms::nearest_on_axis<true>(cone, from_a);
}

/// The centre, as share of the axis, of the ball whose surface is nearest to the point (that it is deepest in). 0 for a
/// sphere.
inline double nearest_on_axis(const Vec3& point, const Capsule& capsule) {
  if (is_one_ball(capsule)) return capsule.taper > 0.0 ? 1.0 : 0.0;
  return nearest_on_axis(two_ball_cone(capsule), point - capsule.a);
}

inline double radius_at(const PlainCone& cone, double t) { return PlainForms::radius_at<true>(cone, t); }

} // namespace tutu::proxies
