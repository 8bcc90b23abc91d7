// A 64-bit hash of content: names files of a cache, and rows that mean the same run.
#pragma once

#include "rig/math.h"

#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace tutu::app {

/// FNV-1a [Fowler, Noll, Vo 1991], numbers a whole at a time. Order matters; every text ends itself.
class ContentHash {
public:
  void add(std::uint64_t number) {
    value_ = (value_ ^ number) * k_prime;
    value_ ^= value_ >> 32; // a product carries upwards only: high bits have to come down
  }
  void add(std::string_view text) {
    for (const char c : text) add(std::uint64_t{static_cast<unsigned char>(c)});
    add(std::uint64_t{256}); // no character
  }
  /// Rounded to 1e-8, far below any length that matters: another processor's sine may differ in its last bit.
  void add(double number) { add(static_cast<std::uint64_t>(std::llround(number * 1e8))); }
  void add(const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }

  std::uint64_t value() const { return value_; }
  std::string text() const { return fmt::format("{:016x}", value_); }

private:
  static constexpr std::uint64_t k_prime = 1099511628211ull;
  std::uint64_t value_ = 14695981039346656037ull;
};

} // namespace tutu::app
