#include "proxies/distance/feature_contact.h"

#include "proxies/distance/closed_forms.h"
#include "proxies/distance/signed_distance.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tutu::proxies {
namespace {

/// Sine of an angle below which two directions count as parallel when a normal is wanted from their cross product:
/// rounding (1e-16) then still leaves seven digits of it.
constexpr double k_parallel = 1e-9;
/// A triangle whose height is below this share of its longest side counts as its edges: from there on rounding (1e-16
/// of the side, over the height's share) would decide where a foot on its plane is.
constexpr double k_flat = 1e-7;

/// m2. A shorter edge (1e-30 m) is a point: products of four lengths remain numbers.
constexpr double k_point = 1e-60;

/// Where the smallest distance is looked for.
struct Nearest {
  double distance; // of the cloth from the surface
  double on_axis;
  std::array<double, 3> weights;
  ClothFeature feature;
  int index;
};

/// The unit vector perpendicular to the edge u that leans against the axis v as the cone does, on the side of u x v or,
/// where `flipped`, of v x u. Nothing where there is none: the two are parallel, or the edge lies steeper than the
/// cone.
std::optional<Vec3> cone_normal(const Vec3& u, const Vec3& v, double taper, bool flipped) {
  const Vec3 n = flipped ? v.cross(u) : u.cross(v);
  const double length = n.norm(), edge = u.norm();
  if (!(length > k_parallel * edge * v.norm())) return std::nullopt;
  const Vec3 inwards = n.cross(u) * (flipped ? -1.0 : 1.0) / (length * edge); // of v, what is perpendicular to u
  const double lean = -taper * edge / length;
  if (!(std::abs(lean) < 1.0)) return std::nullopt;
  return Vec3(lean * inwards + std::sqrt(1.0 - lean * lean) / length * n);
}

Nearest edge_of(int index, int corners, const Vec3& p, const Vec3& q, const PlainCone& cone) {
  const Vec3 u = q - p, r = p - cone.a;
  const double uu = u.squaredNorm();
  const auto [s, t] = !(uu > k_point)     ? PlainForms::Places{0.0, nearest_on_axis(cone, r)}
                      : cone.taper == 0.0 ? PlainForms::nearest_of_cone<false>(cone, u, r, uu)
                                          : PlainForms::nearest_of_cone<true>(cone, u, r, uu);
  const int next = (index + 1) % corners;
  Nearest nearest{(r + s * u - t * cone.axis).norm() - radius_at(cone, t), t, {}, ClothFeature::edge, index};
  nearest.weights[index] = 1.0 - s;
  nearest.weights[next] = s;
  if (s == 0.0 || s == 1.0) {
    nearest.feature = ClothFeature::vertex;
    nearest.index = s == 0.0 ? index : next;
  }
  return nearest;
}

/// `n` as unit vector on the given side; nothing where it is shorter than `least`.
std::optional<Vec3> on_side(const Vec3& n, double least, const Vec3& side) {
  const double length = n.norm();
  if (!(length > least)) return std::nullopt;
  return (n.dot(side) < 0.0 ? -1.0 / length : 1.0 / length) * n;
}

/// The way out where an edge (or a triangle without area, by its longest side) and an axis meet.
Vec3 normal_at_crossing(const Vec3& edge, const PlainCone& cone, const Vec3& side) {
  const Vec3& axis = cone.axis;
  if (cone.taper != 0.0)
    if (const auto normal = cone_normal(edge, axis, cone.taper, side.dot(edge.cross(axis)) < 0.0)) return *normal;
  if (const auto normal = on_side(edge.cross(axis), k_parallel * edge.norm() * axis.norm(), side)) return *normal;
  // Parallel, or one has no length: perpendicular to what direction there is, towards the side.
  const Vec3& along = axis.squaredNorm() >= edge.squaredNorm() ? axis : edge;
  const double squared = along.squaredNorm();
  const Vec3 sideways = squared > 0.0 ? Vec3(side - along.dot(side) / squared * along) : side;
  if (const auto normal = on_side(sideways, k_parallel * side.norm(), side)) return *normal;
  return normal_on_axis({Vec3::Zero(), along, cone.radius, 0.0});
}

/// `fallback` gives the normal where cloth and axis meet.
template <class Fallback>
FeatureContact contact_of(const Nearest& nearest, const Vec3& cloth, const Capsule& capsule, const PlainCone& cone,
                          const Fallback& fallback) {
  FeatureContact contact;
  contact.weights = nearest.weights;
  contact.on_axis = capsule.taper > 0.0 && is_one_ball(capsule) ? 1.0 : nearest.on_axis;
  contact.feature = nearest.feature;
  contact.index = nearest.index;
  const Vec3 away = cloth - (cone.a + nearest.on_axis * cone.axis);
  const double length = away.norm(), radius = radius_at(cone, nearest.on_axis);
  if (nearest.feature == ClothFeature::crossing || length <= k_on_axis) {
    contact.feature = ClothFeature::crossing;
    contact.index = 0;
    contact.distance = -radius;
    contact.normal = fallback();
  } else {
    contact.distance = length - radius;
    contact.normal = 1.0 / length * away;
  }
  contact.closest = cloth - contact.distance * contact.normal;
  return contact;
}

/// A triangle's plane, for points near it.
struct Face {
  Vec3 origin, e1, e2, n; // n = e1 x e2, not unit
  double nn;

  /// Weights of the foot of the perpendicular from `point`; nothing where it falls outside.
  std::optional<std::array<double, 3>> inside(const Vec3& point) const {
    const auto [u, v, w] = PlainForms::foot_on_plane(e1, e2, point - origin, PlainArithmetic::k_least_square);
    if (!(u >= 0.0 && v >= 0.0 && w >= 0.0)) return std::nullopt;
    return std::array{u, v, w};
  }
};

/// Nearest point of axis and triangle: where they cross, or an end of the axis above the face, or an edge.
Nearest nearest_of_triangle(const std::array<Vec3, 3>& p, const std::optional<Face>& face, const PlainCone& cone) {
  const Vec3 b = cone.a + cone.axis;
  std::optional<Nearest> best;
  if (face) {
    const double above_a = face->n.dot(cone.a - p[0]), above_b = face->n.dot(b - p[0]);
    const double height = std::sqrt(face->nn);
    // Where the axis goes through flatter than the cone grows, the wide end is deeper than the crossing.
    if (above_a * above_b < 0.0 && std::abs(cone.taper) * height <= std::abs(above_a - above_b)) {
      const double t = above_a / (above_a - above_b);
      if (const auto weights = face->inside(cone.a + t * cone.axis))
        return {-radius_at(cone, t), t, *weights, ClothFeature::crossing, 0};
    }
    const auto over_a = face->inside(cone.a), over_b = face->inside(b);
    const double distance_a = std::abs(above_a) / height - radius_at(cone, 0.0),
                 distance_b = std::abs(above_b) / height - radius_at(cone, 1.0);
    if (over_a) best = Nearest{distance_a, 0.0, *over_a, ClothFeature::face, 0};
    if (over_b && (!best || distance_b < distance_a)) best = Nearest{distance_b, 1.0, *over_b, ClothFeature::face, 0};
    // The whole axis is above the face, and the distance grows evenly from one end to the other: no edge is nearer.
    if (over_a && over_b) return *best;
  }
  for (int k = 0; k < 3; ++k) {
    const Nearest edge = edge_of(k, 3, p[k], p[(k + 1) % 3], cone);
    if (!best || edge.distance < best->distance) best = edge;
  }
  return *best;
}

} // namespace

FeatureContact edge_contact(const Vec3& p, const Vec3& q, const Capsule& capsule, const Vec3& side) {
  const PlainCone cone = round_cone(capsule);
  const Nearest nearest = edge_of(0, 2, p, q, cone);
  const Vec3 cloth = nearest.weights[0] * p + nearest.weights[1] * q;
  return contact_of(nearest, cloth, capsule, cone, [&] { return normal_at_crossing(q - p, cone, side); });
}

FeatureContact triangle_contact(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Capsule& capsule,
                                const Vec3& side) {
  const std::array<Vec3, 3> p = {p0, p1, p2};
  const Vec3 e1 = p1 - p0, e2 = p2 - p0, e3 = p2 - p1, n = e1.cross(e2);
  const double longest = std::max({e1.squaredNorm(), e2.squaredNorm(), e3.squaredNorm()}), nn = n.squaredNorm();
  std::optional<Face> face;
  if (nn > k_flat * k_flat * longest * longest) face = Face{p0, e1, e2, n, nn};
  const PlainCone cone = round_cone(capsule);
  const Nearest nearest = nearest_of_triangle(p, face, cone);
  const Vec3 cloth = nearest.weights[0] * p0 + nearest.weights[1] * p1 + nearest.weights[2] * p2;
  return contact_of(nearest, cloth, capsule, cone, [&] {
    if (face) return *on_side(n, 0.0, side);
    const Vec3& edge = e1.squaredNorm() == longest ? e1 : e2.squaredNorm() == longest ? e2 : e3;
    return normal_at_crossing(edge, cone, side);
  });
}

} // namespace tutu::proxies
