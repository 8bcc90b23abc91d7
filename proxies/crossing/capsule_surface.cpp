#include "proxies/crossing/capsule_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::proxies {
namespace {

using std::numbers::pi;

/// A ring, or a pole where its radius is 0: a circle about the axis.
struct Ring {
  Vec3 centre;
  double radius;
};

/// The rings of a ball between two latitudes, both included; `steps` parts.
void add_rings(const Vec3& centre, double radius, const Vec3& axis, double from, double to, int steps,
               std::vector<Ring>& rings) {
  for (int k = 0; k <= steps; ++k) {
    const double latitude = std::lerp(from, to, static_cast<double>(k) / steps);
    rings.push_back({centre + radius * std::sin(latitude) * axis, radius * std::cos(latitude)});
  }
}

int steps_of(double angle, int around) { return std::max(1, static_cast<int>(std::ceil(angle * around / (2.0 * pi)))); }

std::vector<Ring> rings_of(const Capsule& capsule, const Vec3& axis, double length, int around) {
  std::vector<Ring> rings;
  const double at_b = capsule.radius + capsule.taper;
  if (length <= std::abs(capsule.taper)) { // one ball holds the other
    const Vec3& centre = capsule.taper > 0.0 ? capsule.b : capsule.a;
    add_rings(centre, capsule.widest(), axis, -0.5 * pi, 0.5 * pi, steps_of(pi, around), rings);
    return rings;
  }
  // Where the cone touches both balls: its normal leans by this from the plane across the axis.
  const double lean = std::asin(-capsule.taper / length);
  add_rings(capsule.a, capsule.radius, axis, -0.5 * pi, lean, steps_of(0.5 * pi + lean, around), rings);
  add_rings(capsule.b, at_b, axis, lean, 0.5 * pi, steps_of(0.5 * pi - lean, around), rings);
  return rings;
}

} // namespace

CapsuleTriangles capsule_surface(const Capsule& capsule, int around) {
  const double length = (capsule.b - capsule.a).norm();
  const Vec3 axis = length > 0.0 ? Vec3((capsule.b - capsule.a) / length) : Vec3::UnitY();
  const Vec3 side = axis.unitOrthogonal(), front = axis.cross(side);
  const std::vector<Ring> rings = rings_of(capsule, axis, length, around);

  CapsuleTriangles surface;
  const auto corners = static_cast<std::uint32_t>(around);
  const auto inner = static_cast<std::uint32_t>(rings.size()) - 2; // without the poles
  surface.positions.push_back(rings.front().centre);
  for (std::uint32_t r = 1; r <= inner; ++r)
    for (std::uint32_t k = 0; k < corners; ++k) {
      const double turn = 2.0 * pi * k / around;
      surface.positions.push_back(rings[r].centre + rings[r].radius * (std::cos(turn) * side + std::sin(turn) * front));
    }
  surface.positions.push_back(rings.back().centre);
  const std::uint32_t last = 1 + inner * corners;
  for (std::uint32_t k = 0; k < corners; ++k) {
    const std::uint32_t next = (k + 1) % corners;
    surface.triangles.push_back({0, 1 + next, 1 + k});
    for (std::uint32_t r = 0; r + 1 < inner; ++r) {
      const std::uint32_t low = 1 + r * corners, high = low + corners;
      surface.triangles.push_back({low + k, low + next, high + next});
      surface.triangles.push_back({low + k, high + next, high + k});
    }
    surface.triangles.push_back({last - corners + k, last - corners + next, last});
  }
  return surface;
}

} // namespace tutu::proxies
