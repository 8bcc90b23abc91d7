// Cloth that meets the true body with all its features: what is between a triangle of cloth and a skinned mesh, beyond
// what its three corners feel.
//
//   BodyMesh --BodyFeatures--> each vertex and edge of the body once
//   each pose: BodyMesh::pose, refresh; then any number of questions, from any number of threads
//
// The corners themselves are left to BodyMesh::signed_distance, which knows the nearest face, edge and vertex of the
// body for a particle, and its side. Two kinds of pairs are found here: where an edge of the cloth crosses an edge of
// the body, and where a vertex of the body meets a face of the cloth.
#pragma once

#include "proxies/body/body_mesh.h"
#include "proxies/contact.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace tutu::proxies {

class FeatureTable;

enum class BodyPair : std::uint8_t {
  edge_edge,  ///< cloth edge, body edge: nearest points inside both, the edges not parallel
  face_vertex ///< cloth face, body vertex: the foot is inside the face
};

/// A pair of features that meet, by the convention of Contact for the cloth's point:
///   cloth = sum_k weights[k] * corner_k = closest + distance * normal,   closest = sum_k on_body[k] * vertex_k.
/// `distance` is negative where the body's feature has come through the cloth. `normal` is unit and points out of the
/// body: that of the cloth's face, or the cross product of the edges, turned to the side of the body's pseudonormal.
struct BodyContact : Contact {
  BodyPair pair = BodyPair::face_vertex;
  std::array<double, 3> weights = {}; ///< of the cloth's corners; >= 0, sum 1; exactly 0 where one has no part
  std::array<double, 3> on_body = {}; ///< of the triangle's vertices; likewise
  int triangle = 0;                   ///< of the body, as given to BodyMesh; one of those that share the feature
};

/// Distances in which a pair is a contact: -depth <= distance <= outside.
struct BodyReach {
  double outside = 0.0; ///< m, >= 0
  double depth = 0.02;  ///< m, >= 0; what is deeper is something else, as the far side of a limb
};

class BodyFeatures {
public:
  /// Of the body as it is posed now. The body must outlive this and stay where it is.
  explicit BodyFeatures(const BodyMesh& body);
  ~BodyFeatures();
  BodyFeatures(BodyFeatures&&) noexcept;
  BodyFeatures& operator=(BodyFeatures&&) noexcept;

  /// After each pose of the body: normals and pseudonormals anew. No question may run meanwhile.
  void refresh();

  /// Appends the pairs between a triangle of cloth (corners, world, m) and the body, in any order, each once; those of
  /// an edge that two triangles of cloth share come with each of the two. Throws std::invalid_argument on non-finite
  /// corners and on a reach that is negative or not finite.
  ///
  /// A feature of the body counts where it is convex or flat and its normal cone holds the normal, within 3 degrees:
  /// nowhere near it does the body come farther out that way. Edges of one triangle count with its normal, those of a
  /// triangle without area not at all. What has come through the cloth counts where the cloth is inside the body, and
  /// the surface that is nearest there lies on the same side: not the far side of a thin limb. A cloth triangle without
  /// area has edges only, an edge without length nothing. Shells that are wholly inside others are not there.
  ///
  /// Returns how far (m) the corners of the cloth and the vertices of the body may move, the farthest of each added up,
  /// before a pair can come that was not found now; 0 where the surface is within `outside`, or where the cloth may be
  /// inside. It holds for bodies that do not go through themselves between now and then.
  double contacts(const std::array<Vec3, 3>& cloth, const BodyReach& reach, std::vector<BodyContact>& contacts) const;

private:
  bool is_outside(const Vec3& point) const;
  bool comes_through(const BodyContact& contact) const;

  const BodyMesh* body_;
  std::unique_ptr<FeatureTable> table_;
};

} // namespace tutu::proxies
