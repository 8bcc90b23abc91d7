#include "cloth/state/particles.h"

#include "cloth/state/tolerances.h"

#include <bit>
#include <cmath>

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

bool is_in_world(const Vec3& v) { // false for what is no number
  return std::abs(v.x()) <= k_world_radius && std::abs(v.y()) <= k_world_radius && std::abs(v.z()) <= k_world_radius;
}

bool is_in_world(std::span<const Vec3> points) {
  bool inside = true; // no early end: the loop is the fast path
  for (const Vec3& p : points) inside = inside && is_in_world(p);
  return inside;
}

bool is_in_world(const Particles& particles) {
  return is_in_world(particles.positions) && is_in_world(particles.velocities);
}

std::uint64_t state_hash(const Particles& particles, std::uint64_t so_far) {
  return hash_numbers(particles.velocities, hash_numbers(particles.positions, so_far));
}

} // namespace tutu::cloth
