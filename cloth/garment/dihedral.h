// The angle between two triangles that share an edge.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace tutu::cloth {

/// Angle over the edge from a to b and its gradients, rad and rad/m.
template <class Scalar> struct Dihedral {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  Scalar sine = 0, cosine = 1; ///< of the angle, times one number > 0
  Vector at_a = Vector::Zero(), at_b = Vector::Zero(), at_c = Vector::Zero(), at_d = Vector::Zero();

  /// In (-pi, pi], 0 when flat; positive when c and d are bent towards the side that n points away from, with n =
  /// (b - a) x (c - a).
  Scalar angle() const { return std::atan2(sine, cosine); }
};

/// c and d are the corners opposite of the edge. The gradient at a corner is along its triangle's normal, one over its
/// height; those of a and b follow since neither translation nor rotation changes the angle [Bridson et al. 2003, eq.
/// 3]. A triangle without area gives angle and gradients of 0.
template <class Scalar, class A, class B, class C, class D>
Dihedral<Scalar> dihedral(const A& a, const B& b, const C& c, const D& d) {
  using Vector = typename Dihedral<Scalar>::Vector;
  Dihedral<Scalar> result;
  const Vector edge = b - a, to_c = c - a, to_d = d - a;
  const Vector n1 = edge.cross(to_c), n2 = to_d.cross(edge);
  const Scalar n1_squared = n1.squaredNorm(), n2_squared = n2.squaredNorm(), squared = edge.squaredNorm();
  if (!(n1_squared > 0) || !(n2_squared > 0)) return result;
  const Scalar length = std::sqrt(squared);
  // |n1| |n2| times sine and cosine: n1 x n2 is along the edge, for both are across it.
  result.sine = -length * n1.dot(to_d);
  result.cosine = n1.dot(n2);
  result.at_c = (-length / n1_squared) * n1;
  result.at_d = (-length / n2_squared) * n2;
  const Scalar along_c = to_c.dot(edge) / squared, along_d = to_d.dot(edge) / squared;
  result.at_b = -along_c * result.at_c - along_d * result.at_d;
  result.at_a = -(result.at_b + result.at_c + result.at_d);
  return result;
}

} // namespace tutu::cloth
