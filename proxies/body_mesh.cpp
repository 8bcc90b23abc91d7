#include "proxies/body_mesh.h"

#include "proxies/feature_contact.h"
#include "proxies/mesh_census.h"
#include "proxies/point_triangle.h"
#include "proxies/query_guard.h"
#include "proxies/solid_angle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace tutu::proxies {
namespace {

/// Nearer than this (m) to the surface a point is on it: its direction from the nearest point is rounding.
constexpr double k_on_surface = 1e-10;

} // namespace

BodyMesh::BodyMesh(std::span<const Vec3f> bind_positions, std::span<const rig::Triangle> triangles)
    : triangles_(triangles.begin(), triangles.end()) {
  require_usable_mesh(bind_positions, triangles);
  topology_ = std::make_unique<MeshTopology>(find_topology(bind_positions, triangles));
  pose(bind_positions);
  MeshFindings found =
      take_census(positions_, triangles_, *topology_, [&](const Vec3& p) { return winding_number(p); });
  census_ = std::move(found.census);
  inner_ = std::move(found.inner);
}

BodyMesh::~BodyMesh() = default;
BodyMesh::BodyMesh(BodyMesh&&) noexcept = default;
BodyMesh& BodyMesh::operator=(BodyMesh&&) noexcept = default;

void BodyMesh::pose(std::span<const Vec3f> positions) {
  positions_.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) positions_[v] = positions[v].cast<double>();
}

void BodyMesh::pose(std::span<const Vec3> positions) { positions_.assign(positions.begin(), positions.end()); }

std::optional<MeshPoint> BodyMesh::nearest(const Vec3& point, double within) const {
  return search(point, within, false);
}

std::optional<MeshPoint> BodyMesh::search(const Vec3& point, double within, bool outer_only) const {
  std::optional<MeshPoint> best;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (outer_only && inner_[topology_->shell_of[t]]) continue;
    const rig::Triangle& v = triangles_[t];
    MeshPoint here = nearest_on_triangle(point, positions_[v[0]], positions_[v[1]], positions_[v[2]]);
    if (!(here.distance < (best ? best->distance : within))) continue;
    here.triangle = static_cast<int>(t);
    best = here;
  }
  return best;
}

Vec3 BodyMesh::pseudonormal(const MeshPoint& on) const {
  const auto area_vector = [&](int t) {
    const rig::Triangle& v = triangles_[t];
    return Vec3((positions_[v[1]] - positions_[v[0]]).cross(positions_[v[2]] - positions_[v[0]]));
  };
  if (on.feature == MeshFeature::face) return area_vector(on.triangle).normalized();
  const rig::Triangle& corners = topology_->corners[on.triangle];
  Vec3 sum = Vec3::Zero();
  if (on.feature < MeshFeature::vertex_a) {
    const int edge = static_cast<int>(on.feature) - static_cast<int>(MeshFeature::edge_ab);
    const std::uint32_t from = corners[edge], to = corners[(edge + 1) % 3];
    for (const int t : topology_->at(from))
      if (std::ranges::count(topology_->corners[t], to) > 0) sum += area_vector(t).normalized();
  } else {
    const std::uint32_t place = corners[static_cast<int>(on.feature) - static_cast<int>(MeshFeature::vertex_a)];
    for (const int t : topology_->at(place)) {
      const rig::Triangle& v = triangles_[t];
      const std::size_t c = std::ranges::find(topology_->corners[t], place) - topology_->corners[t].begin();
      const Vec3 a = positions_[v[(c + 1) % 3]] - positions_[v[c]], b = positions_[v[(c + 2) % 3]] - positions_[v[c]];
      const Vec3 area = a.cross(b);
      sum += std::atan2(area.norm(), a.dot(b)) * area.normalized();
    }
  }
  return sum.squaredNorm() > 0.0 ? Vec3(sum.normalized()) : area_vector(on.triangle).normalized();
}

bool BodyMesh::is_inside(const Vec3& point) const {
  if (census_.rule == SideRule::winding_number) return winding_number(point) > 0.5;
  const MeshPoint on = *search(point, std::numeric_limits<double>::infinity(), false);
  return pseudonormal(on).dot(point - on.closest) < 0.0;
}

Contact BodyMesh::signed_distance(const Vec3& point) const {
  require_usable(point);
  const bool inside = is_inside(point);
  const MeshPoint on = *search(point, std::numeric_limits<double>::infinity(), inside);
  const double distance = inside ? -on.distance : on.distance;
  if (on.distance <= k_on_surface) return {distance, pseudonormal(on), on.closest};
  return {distance, (point - on.closest) / distance, on.closest};
}

double BodyMesh::winding_number(const Vec3& point) const {
  double sum = 0.0;
  for (const rig::Triangle& t : triangles_)
    sum += winding_of(point, positions_[t[0]], positions_[t[1]], positions_[t[2]]);
  return sum;
}

MeshHits BodyMesh::hits(const Capsule& capsule) const {
  require_usable(capsule, 0);
  MeshHits hits;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const rig::Triangle& v = triangles_[t];
    if (triangle_contact(positions_[v[0]], positions_[v[1]], positions_[v[2]], capsule, Vec3::Zero()).distance <= 0.0)
      hits.triangles.push_back(static_cast<int>(t));
  }
  hits.inside = hits.triangles.empty() && is_inside(capsule.a);
  return hits;
}

} // namespace tutu::proxies
