#include "cloth/air/air.h"

namespace tutu::cloth {

AirInStep<proxies::PlainArithmetic> air_in_step(const Air& air, const Vec3& wind, double h) {
  const double in_step = k_air_density * h / 36.0;
  return {in_step * air.pressure, in_step * air.lift, in_step * air.friction, wind};
}

void apply_air(const Garment& garment, std::span<const std::uint8_t> pinned, const Vec3& wind, double h,
               std::span<const Vec3> positions, std::span<Vec3> velocities) {
  const AirInStep<proxies::PlainArithmetic> step = air_in_step(*garment.fabric.air, wind, h);
  const auto inverse_mass = [&](std::uint32_t i) { return pinned[i] ? 0.0 : 1.0 / garment.masses[i]; };
  for (const auto& [a, b, c] : garment.triangles)
    slow_triangle(step, positions[a], positions[b], positions[c], velocities[a], velocities[b], velocities[c],
                  inverse_mass(a), inverse_mass(b), inverse_mass(c));
}

} // namespace tutu::cloth
