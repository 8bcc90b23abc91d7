#include "proxies/body/detail/feature_table.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace tutu::proxies {
namespace {

/// An edge counts as convex while a triangle rises above the plane of the other by less than this (sine of the angle):
/// rounding of single precision, on edges of a millimetre.
constexpr double k_flat_fold = 1e-3;
/// A triangle has no normal when it is lower than this share of its longest edge: rounding of single precision would
/// decide where it faces.
constexpr double k_no_area = 1e-4;
/// Triangles of an edge face each other when the sum of their unit normals is shorter.
constexpr double k_no_normal = 1e-6;

struct EdgeUse {
  std::uint32_t low, high; // places
  int triangle, corner;
};

Vec3 unit_or_zero(const Vec3& v) {
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

} // namespace

FeatureTable::FeatureTable(std::span<const rig::Triangle> triangles, const MeshTopology& topology,
                           std::span<const std::uint8_t> skipped)
    : triangles_(triangles), vertices_(triangles.size(), {-1, -1, -1}), edges_(triangles.size(), {-1, -1, -1}),
      places_(triangles.size(), {-1, -1, -1}), vertex_of_(topology.places), directions_(triangles.size()),
      face_normals_(triangles.size()), vertex_normals_(topology.places) {
  std::vector<bool> owned(topology.places, false);
  std::vector<EdgeUse> uses;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const rig::Triangle& at = topology.corners[t];
    const bool has_edges = at[0] != at[1] && at[1] != at[2] && at[2] != at[0];
    if (!has_edges || (!skipped.empty() && skipped[t])) continue;
    for (int c = 0; c < 3; ++c) {
      places_[t][c] = static_cast<int>(at[c]);
      uses.push_back({std::min(at[c], at[(c + 1) % 3]), std::max(at[c], at[(c + 1) % 3]), t, c});
      if (owned[at[c]]) continue;
      owned[at[c]] = true;
      vertices_[t][c] = static_cast<int>(at[c]);
      vertex_of_[at[c]] = triangles[t][c];
    }
  }
  std::ranges::sort(uses, {}, [](const EdgeUse& use) { return std::tuple(use.low, use.high, use.triangle); });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const EdgeUse& use = uses[i];
    if (i == 0 || use.low != uses[i - 1].low || use.high != uses[i - 1].high) {
      edges_[use.triangle][use.corner] = static_cast<int>(sides_begin_.size());
      sides_begin_.push_back(static_cast<int>(sides_.size()));
      pairs.emplace_back(use.low, use.high);
      pairs.emplace_back(use.high, use.low);
    }
    sides_.push_back({use.triangle, use.corner});
  }
  folds_.resize(sides_begin_.size());
  sides_begin_.push_back(static_cast<int>(sides_.size()));
  std::ranges::sort(pairs);
  neighbours_begin_.assign(topology.places + 1, 0);
  for (const auto& [from, to] : pairs) {
    ++neighbours_begin_[from + 1];
    neighbours_.push_back(vertex_of_[to]);
  }
  for (int p = 0; p < topology.places; ++p) neighbours_begin_[p + 1] += neighbours_begin_[p];
}

void FeatureTable::pose(std::span<const Vec3> positions) {
  std::ranges::fill(vertex_normals_, Vec3::Zero());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (!is_there(static_cast<int>(t))) continue;
    const Vec3 &a = positions[triangles_[t][0]], &b = positions[triangles_[t][1]], &c = positions[triangles_[t][2]];
    const std::array<Vec3, 3> edges = {b - a, c - b, a - c};
    const Vec3 area = edges[0].cross(edges[1]);
    const double twice = area.norm();
    const double longest = std::max({edges[0].squaredNorm(), edges[1].squaredNorm(), edges[2].squaredNorm()});
    face_normals_[t] = Vec3::Zero();
    for (int k = 0; k < 3; ++k) directions_[t][k] = unit_or_zero(edges[k]);
    if (!(twice > k_no_area * longest)) continue;
    face_normals_[t] = area / twice;
    const double at_a = std::atan2(twice, -edges[2].dot(edges[0])), at_b = std::atan2(twice, -edges[0].dot(edges[1]));
    vertex_normals_[places_[t][0]] += at_a * face_normals_[t];
    vertex_normals_[places_[t][1]] += at_b * face_normals_[t];
    vertex_normals_[places_[t][2]] += (M_PI - at_a - at_b) * face_normals_[t];
  }
  for (std::size_t e = 0; e < folds_.size(); ++e) folds_[e] = fold_now(static_cast<int>(e));
}

Vec3 FeatureTable::into(const Side& side) const {
  return face_normals_[side.triangle].cross(directions_[side.triangle][side.corner]);
}

Fold FeatureTable::fold_now(int edge) const {
  const std::span<const Side> all = sides(edge);
  Fold fold;
  for (const Side& side : all) {
    const Vec3& normal = face_normals_[side.triangle];
    if (normal.isZero(0.0) || directions_[side.triangle][side.corner].isZero(0.0)) return {};
    fold.pseudonormal += normal;
  }
  if (!(fold.pseudonormal.norm() > k_no_normal)) return {};
  if (all.size() != 2) return fold;
  fold.first = face_normals_[all[0].triangle];
  if (fold.first.dot(into(all[1])) > k_flat_fold) return {};
  fold.second = face_normals_[all[1].triangle];
  const auto start = [&](const Side& side) { return places_[side.triangle][side.corner]; };
  if (start(all[0]) == start(all[1])) fold.second = -fold.second;
  return fold;
}

bool FeatureTable::vertex_faces(int vertex, const Vec3& direction, std::span<const Vec3> positions) const {
  const Vec3& at = positions[vertex_of_[vertex]];
  for (int i = neighbours_begin_[vertex]; i < neighbours_begin_[vertex + 1]; ++i) {
    const Vec3 away = positions[neighbours_[i]] - at;
    const double rise = direction.dot(away);
    if (rise > 0.0 && rise * rise > k_cone_slack * k_cone_slack * away.squaredNorm()) return false;
  }
  return true;
}

bool FeatureTable::edge_faces(int edge, const Vec3& direction) const {
  return std::ranges::all_of(sides(edge), [&](const Side& side) { return direction.dot(into(side)) <= k_cone_slack; });
}

} // namespace tutu::proxies
