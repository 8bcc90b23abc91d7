#include "cloth/particles.h"

#include <bit>

namespace tutu::cloth {
namespace {

std::uint64_t hash_numbers(std::span<const Vec3> vectors, std::uint64_t hash) {
  constexpr std::uint64_t k_prime =
      1099511628211ull; // FNV-1a, 64 bit [Fowler, Noll, Vo 1991], a whole number at a time
  for (const Vec3& v : vectors)
    for (int axis = 0; axis < 3; ++axis) hash = (hash ^ std::bit_cast<std::uint64_t>(v[axis])) * k_prime;
  return hash;
}

} // namespace

std::uint64_t state_hash(const Particles& particles, std::uint64_t so_far) {
  return hash_numbers(particles.velocities, hash_numbers(particles.positions, so_far));
}

} // namespace tutu::cloth
