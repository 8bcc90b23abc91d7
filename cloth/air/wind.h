// Wind: steady, and gusts of it. The same everywhere at a time.
#pragma once

#include "rig/math.h"

#include <cstdint>
#include <optional>

namespace tutu::cloth {

/// m/s, a hurricane. No steady wind is faster, nor the deviation of gusts: cloth would follow it no farther
/// (k_fastest_particle).
inline constexpr double k_fastest_wind = 50.0;

/// s. Gusts are no shorter: a frame, within which the wind changes evenly, must not step over them.
inline constexpr double k_shortest_gust = 0.02;

/// Added to the steady wind: three independent components, each a smooth curve (cubic B-spline, twice differentiable)
/// through noise that is drawn anew every `period`.
struct Gusts {
  double speed = 1.0;     ///< m/s, the standard deviation of each component; none is more than 2.6 times that
  double period = 1.0;    ///< s, at least k_shortest_gust
  std::uint64_t seed = 1; ///< another one: other gusts of the same kind

  bool operator==(const Gusts&) const = default;
};

struct Wind {
  Vec3 velocity = Vec3::Zero(); ///< world, m/s, where it blows to
  std::optional<Gusts> gusts = {};

  bool is_still() const { return velocity.isZero(0.0) && !gusts; }
  bool operator==(const Wind&) const = default;
};

/// World, m/s, at a time in s. Sums and products alone: the same bits on every machine.
Vec3 wind_at(const Wind& wind, double time);

} // namespace tutu::cloth
