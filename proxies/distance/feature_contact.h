// How an edge or a triangle of cloth meets a capsule, in closed form: what particles alone do not see.
#pragma once

#include "proxies/contact.h"
#include "proxies/shapes.h"

#include <array>

namespace tutu::proxies {

/// Which part of the edge or triangle is nearest to the capsule's axis.
enum class ClothFeature {
  vertex,  ///< weight exactly 1 at FeatureContact::index
  edge,    ///< inside an edge: of a triangle that from vertex `index` to the next
  face,    ///< inside the triangle
  crossing ///< cloth and axis meet: distance == -radius there, and the normal is the caller's word on the side
};

/// An edge or triangle against a collider, by the convention of Contact for the nearest point of the cloth:
///   cloth = sum_k weights[k] * vertex_k = closest + distance * normal,   axis = a + on_axis * (b - a),
///   distance = |cloth - axis| - radius_at(on_axis), the least there is over the cloth and the balls of the capsule.
/// Where several points are as near (an axis parallel to the cloth) it is one of them.
struct FeatureContact : Contact {
  std::array<double, 3> weights = {}; ///< of the vertices; >= 0, sum 1; the third is 0 for an edge
  double on_axis = 0.0;               ///< in [0, 1], of the nearest ball; 0 for a sphere
  ClothFeature feature = ClothFeature::vertex;
  int index = 0;
};

/// The edge p..q against a capsule, or a sphere (a == b) [Ericson 2005, Real-Time Collision Detection, 5.1.9].
/// `side`: roughly the direction from collider to cloth before they could cross, of any length; zero where unknown.
/// It is looked at only where edge and axis meet: the normal is then perpendicular to both, on that side; beside a cone
/// perpendicular to the edge and leaning as the cone does. No length, of edge or axis, is too small.
/// ClosedForms::nearest_of_cone has the form.
FeatureContact edge_contact(const Vec3& p, const Vec3& q, const Capsule& capsule, const Vec3& side);

/// The triangle p0 p1 p2 against a capsule, or a sphere (a == b) [Ericson 2005, 5.1.5, 5.1.10]. `side` as above; where
/// the axis crosses the triangle the normal is the triangle's, on that side (without one: by its winding). A push of
/// the radius along it brings the crossing point out, and is to be repeated where the axis reaches deeper. A triangle
/// without area is its edges.
FeatureContact triangle_contact(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Capsule& capsule,
                                const Vec3& side);

} // namespace tutu::proxies
