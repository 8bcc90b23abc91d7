// What the solvers share within a substep. Private to the folder.
#pragma once

#include "cloth/solver.h"

#include <chrono>
#include <vector>

namespace tutu::cloth {

using Clock = std::chrono::steady_clock;

/// Adds the time since `from` to `sum` (ms) and returns now.
Clock::time_point lap(Clock::time_point from, double& sum);

/// Pinned particles at their targets at `s` of the frame, with the velocity that took them there within `h` seconds.
void follow_pins(const Garment& garment, const FrameInput& input, double s, double h, Particles& particles);

/// Where the sides of a seam meet, from the first (0) to the second (1): their centre of mass; a pinned side leads.
double share_of_second(const Garment& garment, std::span<const std::uint8_t> pinned, const Seam& seam);

/// Both sides of a seam meet at their common centre of mass with their common momentum; a pinned side leads.
void close_seams(const Garment& garment, std::span<const std::uint8_t> pinned, Particles& particles);

/// Says where a run broke: at the first structural spring whose length is not within (1 + k_diverged_stretch) of its
/// rest length, or at any other particle that is out of the world.
Divergence find_divergence(const Garment& garment, int substep, std::span<const Vec3> positions);

/// The same for a known spring. `forces`: those of the springs at `positions`, N.
Divergence describe_divergence(const Garment& garment, int bad_spring, int substep, std::span<const Vec3> positions,
                               std::span<const Vec3> forces);

} // namespace tutu::cloth
