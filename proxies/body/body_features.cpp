#include "proxies/body/body_features.h"

#include "proxies/body/detail/feature_table.h"
#include "proxies/body/detail/mesh_tree.h"
#include "proxies/detail/query_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

namespace tutu::proxies {
namespace {

/// Sine of the angle below which edges are parallel: what is nearest of them is then decided by their ends.
constexpr double k_parallel = 1e-3;
/// A cloth triangle that is lower than this share of its longest edge has no plane.
constexpr double k_flat = 1e-7;
/// m2; an edge whose square is not above it (1e-12 m) has no direction.
constexpr double k_no_length = 1e-24;
/// Cosine between a contact's normal and the nearest way out of the body, above which both lead to one side. In a spike
/// it is the sine of half the angle: 15 degrees.
constexpr double k_same_side = 0.25;
/// A surface that is nearer than a contact's own feature by less than this share is that feature.
constexpr double k_itself = 1e-6;

/// A triangle of cloth and what its pairs have in common.
struct Cloth {
  std::array<Vec3, 3> corners;
  std::array<Vec3, 3> edges;              ///< from corner k to the next
  std::array<double, 3> squared, lengths; ///< of the edges
  Vec3 area;                              ///< edges[0] x edges[1]
  double area_squared = 0.0;              ///< 0 where it has no plane
  std::array<Vec3, 3> across;             ///< area x edges[k]: grows towards the opposite corner
};

Cloth cloth_of(const std::array<Vec3, 3>& corners) {
  Cloth cloth;
  cloth.corners = corners;
  for (int k = 0; k < 3; ++k) {
    cloth.edges[k] = corners[(k + 1) % 3] - corners[k];
    cloth.squared[k] = cloth.edges[k].squaredNorm();
    cloth.lengths[k] = std::sqrt(cloth.squared[k]);
  }
  cloth.area = cloth.edges[0].cross(cloth.edges[1]);
  const double longest = *std::ranges::max_element(cloth.squared), squared = cloth.area.squaredNorm();
  if (longest > k_no_length && squared > k_flat * k_flat * longest * longest) cloth.area_squared = squared;
  for (int k = 0; k < 3; ++k) cloth.across[k] = cloth.area.cross(cloth.edges[k]);
  return cloth;
}

Vec3 sum_of(const std::array<double, 3>& weights, const Vec3& a, const Vec3& b, const Vec3& c) {
  return weights[0] * a + weights[1] * b + weights[2] * c;
}

/// Fills in what follows from the pair's points: `across` is perpendicular to both features, of any length and either
/// way. False where the body's side of it is not known, or the distance is no contact's.
bool complete(BodyContact& contact, const Cloth& cloth, const std::array<Vec3, 3>& body, const Vec3& across,
              const Vec3& pseudonormal, const BodyReach& reach) {
  const double side = across.dot(pseudonormal);
  if (side == 0.0) return false;
  contact.normal = std::copysign(1.0 / across.norm(), side) * across;
  contact.closest = sum_of(contact.on_body, body[0], body[1], body[2]);
  contact.distance = contact.normal.dot(sum_of(contact.weights, cloth.corners[0], cloth.corners[1], cloth.corners[2]) -
                                        contact.closest);
  return -reach.depth <= contact.distance && contact.distance <= reach.outside;
}

/// The cloth's face and the body's vertex; nothing where the foot is outside the face.
std::optional<BodyContact> face_vertex(const Cloth& cloth, const std::array<Vec3, 3>& body, int corner,
                                       const Vec3& pseudonormal, const BodyReach& reach) {
  const Vec3 &p = body[corner], from = p - cloth.corners[0];
  const double height = from.dot(cloth.area), farthest = std::max(reach.outside, reach.depth);
  if (!(height * height <= farthest * farthest * cloth.area_squared)) return std::nullopt;
  // Barycentric coordinates as ratios of areas [Ericson 2005, Real-Time Collision Detection, 3.4].
  const double w2 = cloth.across[0].dot(from), w0 = cloth.across[1].dot(p - cloth.corners[1]);
  const double w1 = cloth.area_squared - w0 - w2;
  if (!(w0 >= 0.0 && w1 >= 0.0 && w2 >= 0.0)) return std::nullopt;
  BodyContact contact;
  contact.pair = BodyPair::face_vertex;
  contact.weights = {w0 / cloth.area_squared, w1 / cloth.area_squared, w2 / cloth.area_squared};
  contact.on_body[corner] = 1.0;
  if (!complete(contact, cloth, body, cloth.area, pseudonormal, reach)) return std::nullopt;
  return contact;
}

/// Edge k of the cloth and the body's edge from `corner` to the next; nothing where they are parallel, or the nearest
/// points of their lines are outside them [Ericson 2005, 5.1.8, the solution by Cramer's rule on the common
/// perpendicular].
std::optional<BodyContact> edge_edge(const Cloth& cloth, int k, const std::array<Vec3, 3>& body, int corner,
                                     const Vec3& pseudonormal, const BodyReach& reach) {
  const Vec3 &u = cloth.edges[k], v = body[(corner + 1) % 3] - body[corner], w = cloth.corners[k] - body[corner];
  const Vec3 n = u.cross(v);
  const double nn = n.squaredNorm(), height = w.dot(n), farthest = std::max(reach.outside, reach.depth);
  if (!(height * height <= farthest * farthest * nn)) return std::nullopt;
  if (!(nn > k_parallel * k_parallel * cloth.squared[k] * v.squaredNorm())) return std::nullopt;
  const double s = v.cross(w).dot(n), t = u.cross(w).dot(n);
  if (!(s >= 0.0 && s <= nn && t >= 0.0 && t <= nn)) return std::nullopt;
  BodyContact contact;
  contact.pair = BodyPair::edge_edge;
  contact.weights[(k + 1) % 3] = s / nn;
  contact.weights[k] = 1.0 - s / nn;
  contact.on_body[(corner + 1) % 3] = t / nn;
  contact.on_body[corner] = 1.0 - t / nn;
  if (!complete(contact, cloth, body, n, pseudonormal, reach)) return std::nullopt;
  return contact;
}

void require_usable(const BodyReach& reach) {
  for (const double length : {reach.outside, reach.depth})
    if (!(length >= 0.0 && std::isfinite(length)))
      throw std::invalid_argument("body features: found a reach of " + std::to_string(length) +
                                  " m, expected a finite one that is not negative");
}

} // namespace

BodyFeatures::BodyFeatures(const BodyMesh& body)
    : body_(&body), table_(std::make_unique<FeatureTable>(body.triangles_, *body.topology_, body.inner_)) {
  refresh();
}

BodyFeatures::~BodyFeatures() = default;
BodyFeatures::BodyFeatures(BodyFeatures&&) noexcept = default;
BodyFeatures& BodyFeatures::operator=(BodyFeatures&&) noexcept = default;

void BodyFeatures::refresh() { table_->pose(body_->positions_); }

double BodyFeatures::contacts(const std::array<Vec3, 3>& corners, const BodyReach& reach,
                              std::vector<BodyContact>& contacts) const {
  for (const Vec3& corner : corners) proxies::require_usable(corner);
  require_usable(reach);
  const Cloth cloth = cloth_of(corners);
  const TriangleProbe probe(corners);
  const double farthest = std::max(reach.outside, reach.depth);
  const double clearance = body_->tree_->clearance(probe, reach.outside, body_->inner_);
  if (clearance > reach.outside) {
    // Far off it makes no difference worth the question which side the cloth is on.
    if (clearance > 2.0 * farthest) return clearance - farthest;
    // Nothing of it crosses the surface: it is where its first corner is. Outside, it must come to the surface before
    // anything can have come through it.
    if (is_outside(corners[0])) return clearance - reach.outside;
    if (clearance > farthest) return clearance - farthest;
  }

  const auto append = [&](BodyContact contact, int triangle) {
    contact.triangle = triangle;
    if (contact.distance >= 0.0 || comes_through(contact)) contacts.push_back(contact);
  };
  body_->tree_->around(probe, farthest, [&](int triangle) {
    if (!table_->is_there(triangle)) return;
    const rig::Triangle& t = body_->triangles_[triangle];
    const std::array<Vec3, 3> body = {body_->positions_[t[0]], body_->positions_[t[1]], body_->positions_[t[2]]};
    if (probe.least_height(body[0], body[1], body[2]) > farthest) return;
    for (int c = 0; c < 3; ++c) {
      if (const int vertex = table_->vertex(triangle, c); vertex >= 0 && cloth.area_squared > 0.0) {
        const auto contact = face_vertex(cloth, body, c, table_->vertex_normal(vertex), reach);
        if (contact && table_->vertex_faces(vertex, contact->normal, body_->positions_)) append(*contact, triangle);
      }
      const int edge = table_->edge(triangle, c);
      if (edge < 0) continue;
      const Fold& fold = table_->fold(edge);
      if (fold.pseudonormal.isZero(0.0)) continue;
      for (int k = 0; k < 3; ++k) {
        if (!(cloth.squared[k] > k_no_length) || !fold.may_bear(cloth.edges[k], cloth.lengths[k])) continue;
        const auto contact = edge_edge(cloth, k, body, c, fold.pseudonormal, reach);
        if (contact && table_->edge_faces(edge, contact->normal)) append(*contact, triangle);
      }
    }
  });
  return 0.0;
}

/// As the nearest surface has it, and as the whole body has it: open bodies and overlapping shells can tell two tales.
bool BodyFeatures::is_outside(const Vec3& point) const {
  const auto on = body_->tree_->nearest(point, std::numeric_limits<double>::infinity(), body_->inner_);
  if (!on || body_->pseudonormal(*on).dot(point - on->closest) < 0.0) return false;
  return body_->census_.rule == SideRule::pseudonormal || !body_->is_inside(point);
}

bool BodyFeatures::comes_through(const BodyContact& contact) const {
  const Vec3 point = contact.closest + contact.distance * contact.normal;
  const double depth = -contact.distance;
  const auto on = body_->tree_->nearest(point, depth * (1.0 - k_itself), body_->inner_);
  if (!on) return true;
  const Vec3 way_out = on->closest - point;
  return body_->pseudonormal(*on).dot(way_out) > 0.0 && contact.normal.dot(way_out) > k_same_side * on->distance;
}

} // namespace tutu::proxies
