#include "rig/interpolation.h"

#include <algorithm>
#include <cmath>

namespace tutu::rig {
namespace {

/// Written from `a` on: what neither moves nor has velocity keeps its bits.
template <typename Value>
Value cubic(const Value& a, const Value& b, const Value& va, const Value& vb, double h, double s) {
  const double r = 1.0 - s;
  return a + (s * s * (3.0 - 2.0 * s)) * (b - a) + (h * s * r * r) * va - (h * s * s * r) * vb;
}

} // namespace

Vec3 log_of(const Quat& rotation) {
  const double side = rotation.w() < 0.0 ? -1.0 : 1.0, sine = rotation.vec().norm();
  // angle / sin(angle / 2) tends to 2; the vector itself is then as small as its rounding.
  const double scale = sine > 1e-150 ? 2.0 * std::atan2(sine, side * rotation.w()) / sine : 2.0;
  return side * scale * rotation.vec();
}

Quat exp_of(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  const double scale = angle > 1e-150 ? std::sin(0.5 * angle) / angle : 0.5;
  Quat result;
  result.w() = std::cos(0.5 * angle);
  result.vec() = scale * rotation_vector;
  return result;
}

double monotone_slope(double left, double right, double h_left, double h_right) {
  if (!(left * right > 0.0)) return 0.0;
  const double parabola = (left * h_right + right * h_left) / (h_left + h_right);
  const double least = std::min({2.0 * std::abs(left), 2.0 * std::abs(right), std::abs(parabola)});
  return std::copysign(least, left);
}

Vec3 monotone_slope(const Vec3& left, const Vec3& right, double h_left, double h_right) {
  Vec3 slope;
  for (int axis = 0; axis < 3; ++axis) slope[axis] = monotone_slope(left[axis], right[axis], h_left, h_right);
  return slope;
}

Vec3 hermite(const Vec3& a, const Vec3& b, const Vec3& va, const Vec3& vb, double h, double s) {
  return cubic(a, b, va, vb, h, s);
}

Eigen::Vector4d hermite(const Eigen::Vector4d& a, const Eigen::Vector4d& b, const Eigen::Vector4d& va,
                        const Eigen::Vector4d& vb, double h, double s) {
  return cubic(a, b, va, vb, h, s);
}

Quat hermite(const Quat& a, const Quat& b, const Vec3& va, const Vec3& vb, double h, double s) {
  const Vec3 w1 = va * (h / 3.0), w3 = vb * (h / 3.0);
  const Vec3 w2 = log_of(exp_of(-w1) * a.conjugate() * b * exp_of(-w3));
  const double r = 1.0 - s;
  return (a * exp_of(w1 * (1.0 - r * r * r)) * exp_of(w2 * (s * s * (3.0 - 2.0 * s))) * exp_of(w3 * (s * s * s)))
      .normalized();
}

} // namespace tutu::rig
