// The force of the air on the triangles of a garment, as part of a substep.
//
// A triangle of area A and unit normal n whose mean velocity relative to the wind is u = u_n n + u_t takes
//   F = -density A / 2 ((pressure |u_n| + lift |u_t|) u_n n + friction |u_t| u_t).
// The first term is the crossflow drag of a plate, the second its lift, as Polhamus adds them up for thin plates at any
// angle of attack a: C_N = K_p sin a cos a + K_v sin^2 a [Polhamus 1966, NASA TN D-3767; here lift and pressure]; the
// third is the friction of both faces. F never pushes: F . u <= 0. The sign of n does not matter. What is along u is
// the drag, what is across it the lift in the usual sense.
//
// So a sheet of areal density s falls at sqrt(2 s g / (density pressure)) face-on and at
// sqrt(2 s g / (density friction)) edge-on.
//
// Each corner takes a third of F with its own velocity in place of the mean one, but for |u_n| and |u_t|: linearised,
//   v' = w + (I + h D / m)^-1 (v - w),  D = density A / 6 ((pressure |u_n| + lift |u_t|) n n^T
//                                                          + friction |u_t| (I - n n^T)),
// w the wind, m the corner's mass; triangle after triangle, each from where the last one left the velocities. A step of
// any length, in any wind, on cloth however light, makes the relative velocity of no corner longer, and turns neither
// its normal nor its tangential part round.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/distance/closed_forms.h"

#include <cstdint>
#include <span>

namespace tutu::cloth {

/// kg/m3, dry air of 20 degrees at sea level.
inline constexpr double k_air_density = 1.2;

#include "cloth/air/air_inl.h"

/// Of a substep of h seconds in a wind, m/s.
AirInStep<proxies::PlainArithmetic> air_in_step(const Air& air, const Vec3& wind, double h);

/// Velocities, m/s, one a particle, after h seconds in a wind, m/s. Pinned particles keep theirs. Of a garment with
/// Fabric::air.
void apply_air(const Garment& garment, std::span<const std::uint8_t> pinned, const Vec3& wind, double h,
               std::span<const Vec3> positions, std::span<Vec3> velocities);

} // namespace tutu::cloth
