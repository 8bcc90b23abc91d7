// A quantity over time as files of motion keep it: keys of its own, and a law between each two.
#pragma once

#include "rig/math.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tutu::rig {

/// What lies between a key and the next.
enum class Law : std::uint8_t {
  step,   ///< the key's value, up to the next key
  linear, ///< the straight way; of rotations the shorter arc at constant angular velocity [Shoemake 1985]
  cubic   ///< Hermite by component; of rotations normalised afterwards [glTF 2.0, C.5]
};

/// Before its first key a curve has the value of that key, behind its last the last one's.
template <typename Value> struct Curve {
  std::vector<double> times; ///< s, never falling; of several keys at one time the last counts from there on: a jump
  std::vector<Value> values; ///< [key]
  std::vector<Law> laws;     ///< [key]: up to the next key
  std::vector<Value> leaving, arriving; ///< [key]: derivative (1/s) behind and before it; empty where no law is cubic

  bool empty() const { return times.empty(); }
};
using VectorCurve = Curve<Vec3>;
using RotationCurve = Curve<Eigen::Vector4d>; ///< x y z w; unit at the keys

/// At `time`, s. The curve has a key. Allocates nothing.
Vec3 value_at(const VectorCurve& curve, double time);
Quat value_at(const RotationCurve& curve, double time);

/// Throws InputError naming `file` and `place` unless times are finite and never fall, sizes agree, numbers are within
/// +-k_largest_number and rotations unit to 1e-6 (tangents, and what lies between, need not be).
void check(const VectorCurve& curve, const std::string& file, const std::string& place);
void check(const RotationCurve& curve, const std::string& file, const std::string& place);

} // namespace tutu::rig
