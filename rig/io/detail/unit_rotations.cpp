#include "rig/io/detail/unit_rotations.h"

#include <cmath>

namespace tutu::rig {
namespace {

constexpr double k_same_bits = 1e-14; // of the squared length: rounding of doubles
constexpr double k_few_digits = 1e-3;
constexpr double k_most_off = 0.1 + 1e-12; // 0.9 itself is in, however it is rounded

/// A length with as many digits as tell it from 1.
std::string shown(double length) {
  std::string text = std::to_string(length);
  while (text.back() == '0') text.pop_back();
  return text;
}

} // namespace

std::optional<Quat> UnitRotations::normalised(const Quat& rotation) {
  ++count_;
  const double length = rotation.norm(), off = std::abs(length - 1.0);
  if (!(off <= k_most_off)) return std::nullopt;
  if (std::abs(rotation.squaredNorm() - 1.0) < k_same_bits) return rotation;
  if (off > k_few_digits) {
    ++off_;
    if (off > std::abs(farthest_ - 1.0)) farthest_ = length;
  }
  return rotation.normalized();
}

std::optional<std::string> UnitRotations::note() const {
  if (off_ == 0) return std::nullopt;
  return std::to_string(off_) + " of " + std::to_string(count_) + (count_ == 1 ? " rotation" : " rotations") +
         (off_ == 1 ? " was" : " were") + " not of unit length (" + (off_ == 1 ? "" : "the farthest ") +
         shown(farthest_) + "): normalised";
}

} // namespace tutu::rig
