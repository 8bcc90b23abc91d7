#include "cloth/particles.h"

#include <bit>

namespace tutu::cloth {
namespace {

std::uint64_t hash_numbers(std::span<const Vec3> vectors, std::uint64_t hash) {
  constexpr std::uint64_t k_prime = 1099511628211ull; // FNV's 64-bit prime [Fowler, Noll, Vo 1991]
  for (const Vec3& v : vectors)
    for (int axis = 0; axis < 3; ++axis) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(v[axis])) * k_prime;
      hash ^= hash >> 32; // a product carries upwards only: without this, sign bits would cancel each other
    }
  return hash;
}

} // namespace

std::uint64_t state_hash(const Particles& particles, std::uint64_t so_far) {
  return hash_numbers(particles.velocities, hash_numbers(particles.positions, so_far));
}

} // namespace tutu::cloth
