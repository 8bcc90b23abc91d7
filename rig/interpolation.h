// The curves between two keys: numbers and rotations, and the tangents that keep them from overshooting.
#pragma once

#include "rig/math.h"

namespace tutu::rig {

/// The rotation vector of the shorter way (axis times angle, rad, at most pi long), and back.
Vec3 log_of(const Quat& rotation);
Quat exp_of(const Vec3& rotation_vector);

/// The slope at a key between two others, so that the cubic Hermite curve on either side is monotone where the keys
/// are: no overshoot, and level at every extremum [Steffen 1990, eq. 11]. `left`, `right`: slopes of the chords;
/// `h_left`, `h_right`: their lengths in time, s.
double monotone_slope(double left, double right, double h_left, double h_right);
/// The same by component.
Vec3 monotone_slope(const Vec3& left, const Vec3& right, double h_left, double h_right);

/// The cubic from `a` to `b` in the time `h` (s), with velocities `va` at the one and `vb` at the other end; s in
/// [0, 1].
Vec3 hermite(const Vec3& a, const Vec3& b, const Vec3& va, const Vec3& vb, double h, double s);
Eigen::Vector4d hermite(const Eigen::Vector4d& a, const Eigen::Vector4d& b, const Eigen::Vector4d& va,
                        const Eigen::Vector4d& vb, double h, double s);

/// The same for rotations: with angular velocities in the frame that turns (rad/s), the cumulative cubic
///   q(s) = a exp(w1 (1 - (1 - s)^3)) exp(w2 (3 s^2 - 2 s^3)) exp(w3 s^3),
///   w1 = va h / 3,  w3 = vb h / 3,  exp(w2) = exp(-w1) a^-1 b exp(-w3)
/// [Kim, Kim and Shin 1995, Hermite quaternion curve]. About one fixed axis it is the cubic of the angle.
Quat hermite(const Quat& a, const Quat& b, const Vec3& va, const Vec3& vb, double h, double s);

} // namespace tutu::rig
