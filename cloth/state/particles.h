// The moving state of one garment.
#pragma once

#include "rig/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tutu::cloth {

/// One entry a particle, in the garment's order; world space, m and m/s.
struct Particles {
  std::vector<Vec3> positions, velocities;

  int count() const { return static_cast<int>(positions.size()); }
};

/// Whether every coordinate is a number and none has left the world (k_world_radius). Collision queries need that. Of
/// particles their velocities too: what is faster will have left within a second.
bool is_in_world(const Vec3& point);
bool is_in_world(std::span<const Vec3> points);
bool is_in_world(const Particles& particles);

/// Over the bits of positions and velocities, in the manner of FNV-1a but a number at a time: two runs are the same run
/// exactly when their hashes agree (up to 2^-64). Negative and positive zero differ. Chain several garments by passing
/// the hash so far.
std::uint64_t state_hash(const Particles& particles, std::uint64_t so_far = 14695981039346656037ull);

} // namespace tutu::cloth
