#include "proxies/point_triangle.h"

#include <algorithm>

namespace tutu::proxies {
namespace {

/// A triangle is taken for its edges when its height is below this share of its longest edge: the barycentric
/// coordinates of its face are noise there.
constexpr double k_flat = 1e-10;

struct OnSegment {
  double t;
  double distance_squared;
};

OnSegment nearest_on_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length_squared = along.squaredNorm();
  const double t = length_squared > 0.0 ? std::clamp((point - from).dot(along) / length_squared, 0.0, 1.0) : 0.0;
  return {t, (point - (from + t * along)).squaredNorm()};
}

MeshPoint found(const Vec3& point, const Vec3& closest, MeshFeature feature, const Vec3& weights) {
  return {(point - closest).norm(), closest, 0, feature, weights};
}

MeshPoint nearest_on_edges(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3* corners[3] = {&a, &b, &c};
  int edge = 0;
  OnSegment best = nearest_on_segment(point, a, b);
  for (int e = 1; e < 3; ++e) {
    const OnSegment other = nearest_on_segment(point, *corners[e], *corners[(e + 1) % 3]);
    if (other.distance_squared < best.distance_squared) best = other, edge = e;
  }
  const int next = (edge + 1) % 3;
  if (best.t <= 0.0 || best.t >= 1.0) {
    const int corner = best.t <= 0.0 ? edge : next;
    return found(point, *corners[corner], static_cast<MeshFeature>(static_cast<int>(MeshFeature::vertex_a) + corner),
                 Vec3::Unit(corner));
  }
  Vec3 weights = Vec3::Zero();
  weights[edge] = 1.0 - best.t;
  weights[next] = best.t;
  return found(point, *corners[edge] + best.t * (*corners[next] - *corners[edge]),
               static_cast<MeshFeature>(static_cast<int>(MeshFeature::edge_ab) + edge), weights);
}

} // namespace

MeshPoint nearest_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = point - a;
  const double longest_squared = std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()});
  if (ab.cross(ac).squaredNorm() <= k_flat * k_flat * longest_squared * longest_squared)
    return nearest_on_edges(point, a, b, c);

  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return found(point, a, MeshFeature::vertex_a, Vec3::UnitX());
  const Vec3 bp = point - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return found(point, b, MeshFeature::vertex_b, Vec3::UnitY());
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double t = d1 / (d1 - d3);
    return found(point, a + t * ab, MeshFeature::edge_ab, {1.0 - t, t, 0.0});
  }
  const Vec3 cp = point - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return found(point, c, MeshFeature::vertex_c, Vec3::UnitZ());
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double t = d2 / (d2 - d6);
    return found(point, a + t * ac, MeshFeature::edge_ca, {1.0 - t, 0.0, t});
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return found(point, b + t * (c - b), MeshFeature::edge_bc, {0.0, 1.0 - t, t});
  }
  const double share = 1.0 / (va + vb + vc);
  const double v = vb * share, w = vc * share;
  return found(point, a + v * ab + w * ac, MeshFeature::face, {1.0 - v - w, v, w});
}

} // namespace tutu::proxies
