#include "cloth/air/wind.h"

#include <cmath>

namespace tutu::cloth {
namespace {

/// A number in [-1, 1) for a knot of a component's curve [Steele, Lea, Flood 2014, SplitMix: the finaliser].
double noise(std::uint64_t seed, int axis, std::int64_t knot) {
  std::uint64_t z = seed;
  for (const std::uint64_t more : {static_cast<std::uint64_t>(axis), static_cast<std::uint64_t>(knot)}) {
    z += (more + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
  }
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

/// Of the knots' noise 1/3, of the spline between them the mean over the knots' interval of the sum of its four squared
/// weights, 151/315: together the variance of the curve; 1 over its root.
constexpr double k_per_deviation = 2.501655;

} // namespace

Vec3 wind_at(const Wind& wind, double time) {
  if (!wind.gusts) return wind.velocity;
  const double knots = time / wind.gusts->period, knot = std::floor(knots), u = knots - knot, r = 1.0 - u;
  const double weights[4] = {r * r * r / 6.0, (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
                             (3.0 * r * r * r - 6.0 * r * r + 4.0) / 6.0, u * u * u / 6.0};
  Vec3 gust = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k)
      gust[axis] += weights[k] * noise(wind.gusts->seed, axis, static_cast<std::int64_t>(knot) + k);
  return wind.velocity + wind.gusts->speed * k_per_deviation * gust;
}

} // namespace tutu::cloth
