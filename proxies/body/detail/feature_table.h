// The vertices and edges of a mesh that moves, each once, with the directions that they face.
#pragma once

#include "proxies/body/detail/mesh_topology.h"
#include "rig/math.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tutu::proxies {

/// How far a direction may lean out of a normal cone, as the sine of the angle (3 degrees): cloth that lies on a facet
/// or on a tangent plane meets its features in spite of rounding and of what one step turns.
inline constexpr double k_cone_slack = 0.05;

/// An edge and the two triangles that it joins.
struct Fold {
  /// Sum of the normals of its triangles, not unit: one for an open edge. Zero where cloth cannot rest on the edge: it
  /// is concave, it has no length, a triangle of it has no area, or they face each other.
  Vec3 pseudonormal = Vec3::Zero();
  /// Normals, unit, of the triangle that the edge is told by and of the other; that one's turned where both run along
  /// the edge the same way. Zero where there are not two.
  Vec3 first = Vec3::Zero(), second = Vec3::Zero();

  /// False where no direction perpendicular to this edge and to `other` is in the normal cone, which leaves out most:
  /// the cone holds one where `other` rises above one triangle and sinks below the other, an arc crossing an arc on the
  /// Gauss map.
  bool may_bear(const Vec3& other, double length) const {
    const double a = other.dot(first), b = other.dot(second), slack = k_cone_slack * length;
    return (a <= slack && -b <= slack) || (-a <= slack && b <= slack);
  }
};

/// Made once from a mesh, posed as often as it moves. Each vertex (place of MeshTopology) and each edge belongs to one
/// of its triangles, which its box holds: a search of boxes that meets every near triangle meets every near feature
/// once.
class FeatureTable {
public:
  /// `skipped`: triangles that are not there, or empty. `triangles` and `topology` must outlive the table.
  FeatureTable(std::span<const rig::Triangle> triangles, const MeshTopology& topology,
               std::span<const std::uint8_t> skipped);

  /// The vertices are there now.
  void pose(std::span<const Vec3> positions);

  bool is_there(int triangle) const { return places_[triangle][0] >= 0; }
  // What a triangle owns; -1 where it does not.
  int vertex(int triangle, int corner) const { return vertices_[triangle][corner]; }
  int edge(int triangle, int corner) const { return edges_[triangle][corner]; } ///< from the corner to the next

  /// The angle-weighted pseudonormal [Baerentzen and Aanaes 2005], not unit; zero where there is none.
  const Vec3& vertex_normal(int vertex) const { return vertex_normals_[vertex]; }
  const Fold& fold(int edge) const { return folds_[edge]; }

  // Whether a unit `direction` is in the normal cone: no nearer way than it leads from the feature's Voronoi region to
  // the surface. For edges it must be perpendicular to the edge.
  bool vertex_faces(int vertex, const Vec3& direction, std::span<const Vec3> positions) const;
  bool edge_faces(int edge, const Vec3& direction) const;

private:
  struct Side {
    int triangle;
    int corner; ///< where the edge begins in it
  };
  std::span<const Side> sides(int edge) const {
    return {sides_.data() + sides_begin_[edge], static_cast<std::size_t>(sides_begin_[edge + 1] - sides_begin_[edge])};
  }
  Vec3 into(const Side& side) const; ///< unit, in the triangle, perpendicular to the edge
  Fold fold_now(int edge) const;

  std::span<const rig::Triangle> triangles_;
  std::vector<std::array<int, 3>> vertices_, edges_; ///< by triangle
  std::vector<std::array<int, 3>> places_;           ///< by triangle: its corners; -1 where it is not there
  std::vector<int> sides_begin_, neighbours_begin_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> neighbours_; ///< of a vertex: those it shares edges with, each as one vertex of the mesh
  std::vector<std::uint32_t> vertex_of_;  ///< place: one vertex of the mesh

  std::vector<std::array<Vec3, 3>> directions_; ///< by triangle: of its edges, unit; zero where one has no length
  std::vector<Vec3> face_normals_;              ///< unit; zero where the triangle has no area
  std::vector<Vec3> vertex_normals_;
  std::vector<Fold> folds_;
};

} // namespace tutu::proxies
