#include "proxies/fit_patches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::proxies::fit {
namespace {

constexpr double k_pi = std::numbers::pi;

struct Frame {
  Vec3 along, across, third;
  double length;
};

Frame frame_of(const Capsule& capsule) {
  Frame frame;
  const Vec3 axis = capsule.b - capsule.a;
  frame.length = axis.norm();
  frame.along = frame.length > 1e-9 ? Vec3(axis / frame.length) : Vec3::UnitY();
  int least = 0;
  frame.along.cwiseAbs().minCoeff(&least);
  frame.across = frame.along.cross(Vec3::Unit(least)).normalized();
  frame.third = frame.along.cross(frame.across);
  return frame;
}

Patch patch(const Capsule& capsule, const Frame& frame, double low, double high, double from, double to) {
  Patch result{low, high, from, to, {}, 0.0, 0.0};
  const double r = capsule.radius, angle = 0.5 * (from + to), turn = to - from, height = 0.5 * (low + high);
  const Vec3 out = std::cos(angle) * frame.across + std::sin(angle) * frame.third;
  if (low >= 0.0 && high <= 1.0) { // the side
    result.middle = capsule.a + height * frame.length * frame.along + r * out;
    const double along = (high - low) * frame.length;
    result.area = r * turn * along;
    // Chord to the corner: half the height, and the chord of half the turn.
    result.radius = std::hypot(0.5 * along, 2.0 * r * std::sin(std::min(0.25 * turn, 0.5 * k_pi)));
    return result;
  }
  // A cap: latitude 0 at its rim, a quarter turn at the pole.
  const bool at_a = high <= 0.0;
  const double rim = (at_a ? -high : low - 1.0) * 0.5 * k_pi, pole = (at_a ? -low : high - 1.0) * 0.5 * k_pi;
  const double latitude = 0.5 * (rim + pole);
  const Vec3 direction = std::cos(latitude) * out + (at_a ? -1.0 : 1.0) * std::sin(latitude) * frame.along;
  result.middle = (at_a ? capsule.a : capsule.b) + r * direction;
  result.area = r * r * turn * (std::sin(pole) - std::sin(rim));
  // Along a meridian, then along the widest parallel: no shorter than the way between.
  result.radius =
      2.0 * r * std::sin(0.25 * (pole - rim)) + 2.0 * r * std::cos(rim) * std::sin(std::min(0.25 * turn, 0.5 * k_pi));
  return result;
}

} // namespace

std::vector<Patch> patches_of(const Capsule& capsule, double size) {
  const Frame frame = frame_of(capsule);
  std::vector<Patch> result;
  const auto rows_of = [&](double low, double high, int rows, double widest) {
    for (int row = 0; row < rows; ++row) {
      const double a = low + (high - low) * row / rows, b = low + (high - low) * (row + 1) / rows;
      const int columns = std::max(4, static_cast<int>(std::ceil(2.0 * k_pi * widest / size)));
      for (int k = 0; k < columns; ++k)
        result.push_back(patch(capsule, frame, a, b, 2.0 * k_pi * k / columns, 2.0 * k_pi * (k + 1) / columns));
    }
  };
  const int cap_rows = std::max(2, static_cast<int>(std::ceil(0.5 * k_pi * capsule.radius / size)));
  for (int row = 0; row < cap_rows; ++row) { // fewer columns towards the poles
    const double rim = static_cast<double>(row) / cap_rows, pole = static_cast<double>(row + 1) / cap_rows;
    const double widest = capsule.radius * std::cos(0.5 * (rim + pole) * 0.5 * k_pi);
    rows_of(-pole, -rim, 1, widest);
    rows_of(1.0 + rim, 1.0 + pole, 1, widest);
  }
  if (frame.length > 1e-6)
    rows_of(0.0, 1.0, std::max(1, static_cast<int>(std::ceil(frame.length / size))), capsule.radius);
  return result;
}

std::vector<Patch> quarters(const Capsule& capsule, const Patch& whole) {
  const Frame frame = frame_of(capsule);
  const double height = 0.5 * (whole.low + whole.high), angle = 0.5 * (whole.from + whole.to);
  return {patch(capsule, frame, whole.low, height, whole.from, angle),
          patch(capsule, frame, whole.low, height, angle, whole.to),
          patch(capsule, frame, height, whole.high, whole.from, angle),
          patch(capsule, frame, height, whole.high, angle, whole.to)};
}

} // namespace tutu::proxies::fit
