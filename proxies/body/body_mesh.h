// The true body: the skinned mesh as a solid, for validation and for reference runs.
//
//   bind pose --BodyMesh--> census: what the mesh is, and how inside is told from outside
//   each frame: pose(skinned positions), then any number of questions, from any number of threads
//
// World space, m. Signed distance is negative inside; conventions of contact.h.
#pragma once

#include "proxies/contact.h"
#include "proxies/shapes.h"
#include "rig/mesh.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::proxies {

struct MeshTopology;
class MeshTree;

/// What of a triangle a b c is nearest to a point.
enum class MeshFeature : std::uint8_t { face, edge_ab, edge_bc, edge_ca, vertex_a, vertex_b, vertex_c };

/// The nearest point of a surface: closest = sum_k weights[k] * corner_k, distance = |point - closest|.
struct MeshPoint {
  double distance = 0.0; ///< m, >= 0: no side
  Vec3 closest = Vec3::Zero();
  int triangle = 0; ///< as given to BodyMesh; where several are as near, one of them
  MeshFeature feature = MeshFeature::face;
  Vec3 weights = Vec3::Zero(); ///< barycentric, >= 0, sum 1; exactly 1 or 0 where the feature says so
};

/// How inside is told from outside.
enum class SideRule {
  pseudonormal,  ///< angle-weighted, nearest feature [Baerentzen and Aanaes 2005]: one closed surface, clear of itself
  winding_number ///< generalised, above 1/2 [Jacobson et al. 2013]: open, overlapping or several surfaces
};

/// A point against the surface, and the part of it that is nearest.
struct MeshContact : Contact {
  int triangle = 0; ///< as of MeshPoint
  MeshFeature feature = MeshFeature::face;
  Vec3 weights = Vec3::Zero(); ///< closest = sum_k weights[k] * corner_k
};

/// What a mesh was found to be in its bind pose, and the rule that follows. Vertices at the same place count as one:
/// a texture seam is no opening.
struct MeshCensus {
  int vertices = 0, triangles = 0; ///< as given
  int welded_vertices = 0;         ///< places
  int shells = 0;                  ///< parts that share no edge
  int inner_shells = 0;            ///< wholly inside the others
  int inverted_shells = 0;         ///< turned inside out, and not inside others (where that makes a cavity)
  int open_edges = 0;              ///< of one triangle
  int nonmanifold_edges = 0;       ///< of more than two
  int pinched_vertices = 0;        ///< where two or more fans of triangles meet in one place
  int mended_triangles = 0;        ///< that ran against their neighbours, and were turned back
  int turned_triangles = 0;        ///< that run against most of their shell, and were not
  int flat_triangles = 0;          ///< without area
  double area = 0.0;               ///< m2
  double volume = 0.0;             ///< m3; an open shell counts as if closed from its middle
  SideRule rule = SideRule::pseudonormal;
  std::string reason; ///< why that rule, as one clause
};

/// "22 triangles were turned over: mended", where some were.
std::optional<std::string> note_of(const MeshCensus& census);

/// How a capsule (or sphere) meets the surface.
struct MeshHits {
  std::vector<int> triangles; ///< those that reach into the capsule, rising
  bool inside = false;        ///< it meets none of them and is wholly inside the body

  bool hit() const { return inside || !triangles.empty(); }
};

class BodyMesh {
public:
  /// Takes a census and is posed as given. Triangles that run against their neighbours are turned back where there
  /// is no doubt which those are: in closed shells with two sides, and a few in open ones. Throws
  /// std::invalid_argument, in words for the user, on what has no sides: no triangle, indices out of range, non-finite
  /// positions, no area, no volume, the whole or more than 1 % of it turned inside out.
  BodyMesh(std::span<const Vec3f> bind_positions, std::span<const rig::Triangle> triangles);
  ~BodyMesh();
  BodyMesh(BodyMesh&&) noexcept;
  BodyMesh& operator=(BodyMesh&&) noexcept;

  const MeshCensus& census() const { return census_; }

  /// The vertices are there now: as many as at the start, world, m. The tree is refitted, never rebuilt. Throws
  /// std::invalid_argument on non-finite positions. No question may run meanwhile.
  void pose(std::span<const Vec3f> positions);
  void pose(std::span<const Vec3> positions);

  std::span<const Vec3> positions() const { return positions_; }
  std::span<const rig::Triangle> triangles() const { return triangles_; } ///< in the order given; mended

  // Questions may be asked from several threads at once. Points must be finite.

  /// The nearest point of any triangle, where one is nearer than `within` (m; may be infinite).
  std::optional<MeshPoint> nearest(const Vec3& point, double within) const;

  /// From the body's surface. A point inside is measured to the shells that are not wholly inside others. On the
  /// surface itself the normal is the pseudonormal of the nearest feature.
  MeshContact signed_distance(const Vec3& point) const;

  /// By the rule of the census; a point on the surface may be either.
  bool is_inside(const Vec3& point) const;

  /// How often the surface goes round the point, exactly: solid angles over 4 pi [van Oosterom and Strackee 1983], one
  /// triangle after the other. A whole number where the mesh is closed.
  double winding_number(const Vec3& point) const;

  /// Exact contacts with a capsule of radius > 0.
  MeshHits hits(const Capsule& capsule) const;

private:
  friend class BodyFeatures; // asks the same tree

  void require_count(std::size_t vertices) const;
  void refit();
  bool winds_around(const Vec3& point) const;
  Vec3 pseudonormal(const MeshPoint& on) const;

  std::vector<Vec3> positions_;
  std::vector<rig::Triangle> triangles_;
  std::unique_ptr<MeshTopology> topology_;
  std::unique_ptr<MeshTree> tree_;
  MeshCensus census_;
  bool is_closed_ = false;          ///< outside the box of all is outside
  std::vector<std::uint8_t> inner_; ///< triangle: of a shell wholly inside the others; empty where there is none
};

} // namespace tutu::proxies
