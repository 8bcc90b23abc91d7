// The nearest point of a triangle, in closed form, in double.
#pragma once

#include "proxies/body/body_mesh.h"

#include <algorithm>

namespace tutu::proxies {

/// Where on a triangle a b c: a + v * (b - a) + w * (c - a).
struct OnTriangle {
  MeshFeature feature;
  double v, w;
};

/// The point of triangle a b c that is nearest to `point` [Ericson 2005, Real-Time Collision Detection, 5.1.5]. A
/// triangle without area is its edges.
OnTriangle nearest_place(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

/// The same with the distance. `triangle` of the result is left at 0.
MeshPoint nearest_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

// In the header, for the descent of a tree has it in its innermost loop.

namespace detail {
OnTriangle nearest_on_edges(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);
/// A triangle is taken for its edges when its area is below this share of its longest edge squared: the barycentric
/// coordinates of its face are noise there.
inline constexpr double k_flat = 1e-10;
} // namespace detail

inline OnTriangle nearest_place(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = point - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {MeshFeature::vertex_a, 0.0, 0.0};
  const Vec3 bp = point - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {MeshFeature::vertex_b, 1.0, 0.0};
  const Vec3 cp = point - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {MeshFeature::vertex_c, 0.0, 1.0};
  const double longest = std::max(ab.squaredNorm(), ac.squaredNorm());
  if (ab.cross(ac).squaredNorm() <= detail::k_flat * detail::k_flat * longest * longest)
    return detail::nearest_on_edges(point, a, b, c);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {MeshFeature::edge_ab, d1 / (d1 - d3), 0.0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {MeshFeature::edge_ca, 0.0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {MeshFeature::edge_bc, 1.0 - t, t};
  }
  const double share = 1.0 / (va + vb + vc);
  return {MeshFeature::face, vb * share, vc * share};
}

} // namespace tutu::proxies
