// Where points, edges and triangles are nearest to a capsule, by search: the twin of proxies/distance. It knows how far
// a point is from one ball, and that this is convex in the ball's place and in the point's, and nothing else.
#pragma once

#include "proxies/shapes.h"

#include <algorithm>
#include <array>

namespace tutu::test {

/// What a search found: how far the cloth is from the surface, where on the cloth and on the axis, and the unit vector
/// from the axis to the cloth (zero where they meet).
struct Searched {
  double distance = 0.0;
  Vec3 cloth = Vec3::Zero();
  double t = 0.0, s = 0.0; ///< of the axis, and of an edge
  Vec3 normal = Vec3::Zero();
};

/// Where in [0, 1] a function that rises changes its sign, to 2^-halvings; exactly at an end where it never does.
template <class Slope> double sign_change(int halvings, const Slope& slope) {
  if (!(slope(0.0) < 0.0)) return 0.0;
  if (!(slope(1.0) > 0.0)) return 1.0;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Searches halve their intervals this often: to the last bit, or, where three are nested, so that distances miss by
/// 1e-8 where cloth and axis meet, and by nothing elsewhere.
constexpr int k_to_the_bit = 55, k_nested = 26;

/// The ball about a + t (b - a), of all t, that the point is nearest to.
inline Searched search_point(const Vec3& point, const proxies::Capsule& capsule, int halvings = k_to_the_bit) {
  const Vec3 axis = capsule.b - capsule.a, from_a = point - capsule.a;
  const auto away = [&](double t) { return Vec3(from_a - t * axis); };
  const double t = sign_change(halvings, [&](double at) { // the slope of |away| - radius
    const double length = away(at).norm();
    return (length > 0.0 ? -away(at).dot(axis) / length : 0.0) - capsule.taper;
  });
  const double length = away(t).norm();
  return {length - capsule.radius_at(t), point, t, 0.0, length > 0.0 ? Vec3(away(t) / length) : Vec3(Vec3::Zero())};
}

/// The point of the edge p..q that is the nearest: where the distance, whose gradient is the normal, no longer falls.
inline Searched search_edge(const Vec3& p, const Vec3& q, const proxies::Capsule& capsule,
                            int halvings = k_to_the_bit) {
  const auto at = [&](double s) { return search_point((1.0 - s) * p + s * q, capsule, halvings); };
  const double s = sign_change(halvings, [&](double on) { return at(on).normal.dot(q - p); });
  Searched found = at(s);
  found.s = s;
  return found;
}

/// Of the triangle's sections along p1..p2 the one that is the nearest.
inline Searched search_triangle(const std::array<Vec3, 3>& p, const proxies::Capsule& capsule,
                                int halvings = k_nested) {
  const Vec3 e = p[1] - p[0], f = p[2] - p[0];
  const auto section = [&](double u) { return search_edge(p[0] + u * e, p[0] + u * f, capsule, halvings); };
  return section(sign_change(halvings, [&](double u) { // on the way w to the section's nearest point, normal . w
    const Searched on = section(u);
    return u > 0.0 ? on.normal.dot((1.0 - on.s) * e + on.s * f) : std::min(on.normal.dot(e), on.normal.dot(f));
  }));
}

/// Nothing of the cloth within `size` of `middle` is nearer to the surface than this.
inline double least_distance(const Vec3& middle, double size, const proxies::Capsule& capsule) {
  const double half = 0.5 * (capsule.b - capsule.a).norm();
  return (middle - 0.5 * (capsule.a + capsule.b)).norm() - half - capsule.widest() - size;
}

} // namespace tutu::test
