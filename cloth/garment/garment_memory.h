// What a garment costs in memory, before it is built.
#pragma once

#include "cloth/garment/garment.h"

#include <cstdint>

namespace tutu::cloth {

/// How many particles build_garment() would make of it.
std::uint64_t particles_of(const GarmentDescription& description);

/// Bytes a particle, all told: rest shape with its springs, solver, contact, and what building them takes for a while.
/// Measured as the peak of the process (tests/cloth/garment/test_garment_memory.cpp does it again).
inline constexpr double k_bytes_a_woven_particle = 960.0; ///< of grids and tubes: 640 to 780, pinched ones 960
inline constexpr double k_bytes_a_mesh_particle = 1030.0; ///< of discs and meshes: 910 to 1020, 720 of mass_spring
/// Bytes a tile of 128 woven particles keeps for each collider that may come near it; about so many a particle of a
/// mesh that is near to it.
inline constexpr double k_bytes_a_tile_and_collider = 40.0;

/// Bytes that the garment takes while it is simulated among so many colliders, at the most.
double memory_of(const GarmentDescription& description, std::size_t colliders = 0);

/// Throws InputError where that is over memory_limit().
void check_garment_memory(const GarmentDescription& description);

} // namespace tutu::cloth
