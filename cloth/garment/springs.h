// Forces and energy of a garment's springs, as the formulas have them.
#pragma once

#include "cloth/garment/garment.h"

#include <optional>
#include <span>

namespace tutu::cloth {

/// forces += those of all springs at `positions`: for spring (i, j), K (|d| - L) d/|d| on i with d = x_j - x_i, the
/// opposite on j. N. Returns the index of the first structural spring whose length is not within
/// (1 + k_diverged_stretch) of its rest length.
std::optional<int> add_spring_forces(const Garment& garment, std::span<const Vec3> positions, std::span<Vec3> forces);

/// forces += those of a damper K `time` (N s/m) beside each spring at `positions`: on i K time ((v_j - v_i) . n) n with
/// n = d/|d|, the opposite on j. What falls or turns as a whole is not damped.
void add_damping_forces(const Garment& garment, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                        double time, std::span<Vec3> forces);

/// Sum of K (|d| - L)^2 / 2 over all springs, J. The forces are its negative gradient.
double elastic_energy(const Garment& garment, std::span<const Vec3> positions);

} // namespace tutu::cloth
