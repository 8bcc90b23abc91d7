// Private to skinning (rig/skin*.cpp): the methods that blend rigid motions instead of matrices, on either scalar.
#pragma once

#include "rig/skin.h"

namespace tutu::rig::skin_detail {

/// model_from_bind of one slot.
template <class Scalar> struct Rigid {
  Eigen::Quaternion<Scalar, Eigen::DontAlign> rotation;
  Eigen::Matrix<Scalar, 3, 1> translation;
};

template <class Scalar> using Vector = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar> using Rotation = Eigen::Quaternion<Scalar, Eigen::DontAlign>;

/// sum_k w_k q_k with every q_k on the side of the first, which has the largest weight; not normalised. `rigid(k)` is
/// the slot of influence k, `add(k, w)` is told the signed weight of each.
template <class Scalar, class RigidOf, class Add>
Rotation<Scalar> blended_rotation(const float* weights, int influences, const RigidOf& rigid, const Add& add) {
  const Rotation<Scalar> pivot = rigid(0).rotation;
  Rotation<Scalar> sum(Scalar(0), Scalar(0), Scalar(0), Scalar(0));
  for (int k = 0; k < influences && weights[k] > 0.0f; ++k) { // weights fall: behind the first 0 are only others
    const Rotation<Scalar> q = rigid(k).rotation;
    const Scalar w = pivot.dot(q) < Scalar(0) ? -Scalar(weights[k]) : Scalar(weights[k]);
    sum.coeffs() += w * q.coeffs();
    add(k, w);
  }
  return sum;
}

/// Dual quaternion linear blending [Kavan et al. 2007]: v' of `v`, and the rotation for normals.
template <class Scalar, class RigidOf>
Vector<Scalar> dual_quaternion_point(const Vector<Scalar>& v, const float* weights, int influences,
                                     const RigidOf& rigid, Rotation<Scalar>& rotation) {
  // b0 + eps be; of a motion (q, t): be = 1/2 t q.
  Rotation<Scalar> dual(Scalar(0), Scalar(0), Scalar(0), Scalar(0));
  const Rotation<Scalar> real = blended_rotation<Scalar>(weights, influences, rigid, [&](int k, Scalar w) {
    const Rigid<Scalar> motion = rigid(k);
    const Rotation<Scalar> t(Scalar(0), motion.translation.x(), motion.translation.y(), motion.translation.z());
    dual.coeffs() += Scalar(0.5) * w * (t * motion.rotation).coeffs();
  });
  // Half turns apart and equally weighted, rotations can cancel; then there is no good answer, and the first will do.
  const Scalar length = real.norm();
  if (!(length > Scalar(1e-6))) {
    rotation = rigid(0).rotation;
    return rotation * v + rigid(0).translation;
  }
  rotation.coeffs() = real.coeffs() / length;
  dual.coeffs() /= length;
  return rotation * v + Scalar(2) * (dual * rotation.conjugate()).vec();
}

/// Optimised centres of rotation [Le and Hodgins 2016]: the vertex turns about its centre by the blended
/// rotation, the centre moves by linear blending.
template <class Scalar, class RigidOf>
Vector<Scalar> centre_of_rotation_point(const Vector<Scalar>& v, const Vector<Scalar>& centre, const float* weights,
                                        int influences, const RigidOf& rigid, Rotation<Scalar>& rotation) {
  Vector<Scalar> moved = Vector<Scalar>::Zero();
  const Rotation<Scalar> sum = blended_rotation<Scalar>(weights, influences, rigid, [&](int k, Scalar) {
    const Rigid<Scalar> motion = rigid(k);
    moved += Scalar(weights[k]) * (motion.rotation * centre + motion.translation);
  });
  const Scalar length = sum.norm();
  if (length > Scalar(1e-6)) rotation.coeffs() = sum.coeffs() / length;
  else rotation = rigid(0).rotation;
  return rotation * (v - centre) + moved;
}

/// One vertex by the skin's method; not for Skinning::linear.
template <class Scalar, class RigidOf>
Vector<Scalar> rigid_point(const Mesh& mesh, const Skin& skin, int vertex, const RigidOf& rigid,
                           Rotation<Scalar>& rotation) {
  const Vector<Scalar> v = mesh.positions[vertex].cast<Scalar>();
  const float* weights = skin.weights.data() + static_cast<std::size_t>(vertex) * skin.influences;
  if (skin.method == Skinning::dual_quaternion)
    return dual_quaternion_point(v, weights, skin.influences, rigid, rotation);
  const Vector<Scalar> centre = skin.centres[vertex].cast<Scalar>();
  return centre_of_rotation_point(v, centre, weights, skin.influences, rigid, rotation);
}

} // namespace tutu::rig::skin_detail
