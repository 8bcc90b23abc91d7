#include "proxies/body/point_triangle.h"

#include "proxies/distance/signed_distance.h"

#include <array>

namespace tutu::proxies {
namespace {

struct OnSegment {
  double t;
  double distance_squared;
};

OnSegment on_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const double t = nearest_on_axis(point, {from, to});
  return {t, (point - (from + t * (to - from))).squaredNorm()};
}

MeshFeature feature(MeshFeature first, int index) { return static_cast<MeshFeature>(static_cast<int>(first) + index); }

} // namespace

OnTriangle detail::nearest_on_edges(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<const Vec3*, 3> corners = {&a, &b, &c};
  int edge = 0;
  OnSegment best = on_segment(point, a, b);
  for (int e = 1; e < 3; ++e) {
    const OnSegment other = on_segment(point, *corners[e], *corners[(e + 1) % 3]);
    if (other.distance_squared < best.distance_squared) best = other, edge = e;
  }
  const int next = (edge + 1) % 3;
  std::array<double, 3> weights = {};
  weights[edge] = 1.0 - best.t;
  weights[next] = best.t;
  if (best.t <= 0.0) return {feature(MeshFeature::vertex_a, edge), weights[1], weights[2]};
  if (best.t >= 1.0) return {feature(MeshFeature::vertex_a, next), weights[1], weights[2]};
  return {feature(MeshFeature::edge_ab, edge), weights[1], weights[2]};
}

MeshPoint nearest_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const OnTriangle on = nearest_place(point, a, b, c);
  MeshPoint found;
  found.feature = on.feature;
  found.weights = {1.0 - on.v - on.w, on.v, on.w};
  switch (on.feature) { // a corner is met exactly, and an edge's third weight is no rounding
  case MeshFeature::vertex_a: found.closest = a; break;
  case MeshFeature::vertex_b: found.closest = b; break;
  case MeshFeature::vertex_c: found.closest = c; break;
  case MeshFeature::edge_bc:
    found.weights.x() = 0.0;
    found.closest = b + on.w * (c - b);
    break;
  default: found.closest = a + on.v * (b - a) + on.w * (c - a);
  }
  found.distance = (point - found.closest).norm();
  return found;
}

} // namespace tutu::proxies
