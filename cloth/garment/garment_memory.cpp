#include "cloth/garment/garment_memory.h"

#include "cloth/garment/detail/garment_mesh.h"
#include "rig/io/memory_limit.h"

namespace tutu::cloth {
namespace {

std::uint64_t product(int rows, int columns) {
  return static_cast<std::uint64_t>(std::max(rows, 0)) * static_cast<std::uint64_t>(std::max(columns, 0));
}

std::uint64_t particles_in(const GridShape& grid) { return product(grid.rows, grid.columns); }
std::uint64_t particles_in(const TubeShape& tube) { return product(tube.rows, tube.columns); }
std::uint64_t particles_in(const DiscShape& disc) { return disc_particles(disc); }
std::uint64_t particles_in(const MeshShape& mesh) { return mesh.positions.size(); }

constexpr const char* k_places[] = {"/shape/grid", "/shape/tube", "/shape/disc", "/shape/mesh"}; // of the variant

} // namespace

std::uint64_t particles_of(const GarmentDescription& description) {
  return std::visit([](const auto& shape) { return particles_in(shape); }, description.shape);
}

double memory_of(const GarmentDescription& description, std::size_t colliders) {
  constexpr double k_particles_a_tile = 128.0;
  const bool is_woven =
      std::holds_alternative<GridShape>(description.shape) || std::holds_alternative<TubeShape>(description.shape);
  const auto particles = static_cast<double>(particles_of(description));
  return particles * (is_woven ? k_bytes_a_woven_particle : k_bytes_a_mesh_particle) +
         (particles / k_particles_a_tile + 1.0) * static_cast<double>(colliders) * k_bytes_a_tile_and_collider;
}

void check_garment_memory(const GarmentDescription& description) {
  check_memory(memory_of(description), description.file, k_places[description.shape.index()],
               "a garment of " + with_commas(particles_of(description)) + " particles");
}

} // namespace tutu::cloth
