#include "cloth/garment/detail/garment_mesh.h"

#include "cloth/garment/elements.h"
#include "rig/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::cloth {
namespace {

constexpr int k_most_rings = 1024;                  // 3 million particles
constexpr double k_least_area = 1e-12;              // m2: a triangle of a micrometre's size is a crumb of the modeller
constexpr std::size_t k_most_particles = 1u << 24u; // as many as of a grid

/// The triangles between two closed rings of particles, or a ring and a centre (count 1).
void stitch(std::uint32_t inner, int inner_count, std::uint32_t outer, int outer_count, MeshShape& mesh) {
  const auto at = [](std::uint32_t first, int count, int k) { return first + static_cast<std::uint32_t>(k % count); };
  const int inner_steps = inner_count == 1 ? 0 : inner_count;
  for (int i = 0, o = 0; i < inner_steps || o < outer_count;) {
    // That side goes on which makes the shorter of the two diagonals.
    const bool outwards =
        i >= inner_steps || (o < outer_count && (2 * o + 1.0) * inner_count <= (2 * i + 1.0) * outer_count);
    const std::uint32_t a = at(inner, inner_count, i), b = at(outer, outer_count, o);
    if (outwards) mesh.triangles.push_back({a, b, at(outer, outer_count, ++o)});
    else mesh.triangles.push_back({a, b, at(inner, inner_count, ++i)});
  }
}

/// Particles of triangles with an area, in their order, and those triangles.
void take_sound_triangles(const MeshShape& mesh, const std::string& file, Garment& garment) {
  if (mesh.positions.size() > k_most_particles)
    throw InputError(file, "/shape", std::to_string(mesh.positions.size()) + " particles",
                     "at most " + std::to_string(k_most_particles));
  const auto& x = mesh.positions;
  std::vector<int> particle_of(x.size(), -1);
  std::vector<std::array<std::uint32_t, 3>> sound;
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t)
      if (corner >= x.size())
        throw InputError(file, "/shape", "a triangle of particle " + std::to_string(corner),
                         "an index below " + std::to_string(x.size()));
    if (!(triangle_area(x[t[0]], x[t[1]], x[t[2]]) > k_least_area)) continue;
    sound.push_back(t);
    for (const std::uint32_t corner : t) particle_of[corner] = 0;
  }
  if (sound.empty()) throw InputError(file, "/shape", "no triangle with an area", "a surface");
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (particle_of[i] < 0) continue;
    particle_of[i] = garment.particle_count();
    garment.rest_positions.push_back(x[i]);
  }
  for (const auto& t : sound)
    garment.triangles.push_back({static_cast<std::uint32_t>(particle_of[t[0]]),
                                 static_cast<std::uint32_t>(particle_of[t[1]]),
                                 static_cast<std::uint32_t>(particle_of[t[2]])});
}

/// Of the ring at this radius (of the disc's) where rings are `step` apart.
int particles_around(double radius, double step) {
  return radius > 0.0 ? std::max(6, static_cast<int>(std::lround(6.0 * radius / step))) : 1;
}

} // namespace

std::uint64_t disc_particles(const DiscShape& disc) {
  if (!(disc.hole >= 0.0 && disc.hole < 1.0) || disc.rings < 1) return 0;
  const double step = (1.0 - disc.hole) / disc.rings;
  // Rings between the first and the last, the mean of both each: six for each step of their radius.
  const double all = 0.5 * (disc.rings + 1.0) * (particles_around(disc.hole, step) + 6.0 / step);
  return static_cast<std::uint64_t>(all);
}

MeshShape triangulated(const DiscShape& disc, const GarmentDescription& description) {
  if (!(disc.radius_x > 0.0 && disc.radius_z > 0.0) || !(disc.hole >= 0.0 && disc.hole < 1.0) || disc.rings < 1 ||
      disc.rings > k_most_rings)
    throw InputError(description.file, "/shape/disc", "a disc without area or with too many rings",
                     "a radius above 0, a hole below it, and 1.." + std::to_string(k_most_rings) + " rings");
  MeshShape mesh;
  const double step = (1.0 - disc.hole) / disc.rings; // of the radius
  std::uint32_t inner = 0;
  int inner_count = 0;
  for (int ring = 0; ring <= disc.rings; ++ring) {
    const double radius = disc.hole + ring * step;
    const int count = particles_around(radius, step);
    const auto outer = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < count; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / count;
      mesh.positions.push_back(
          disc.centre + Vec3(disc.radius_x * radius * std::sin(angle), 0.0, disc.radius_z * radius * std::cos(angle)));
    }
    if (ring > 0) stitch(inner, inner_count, outer, count, mesh);
    inner = outer;
    inner_count = count;
  }
  return mesh;
}

void build_from_triangles(const MeshShape& mesh, const GarmentDescription& description, Garment& garment) {
  take_sound_triangles(mesh, description.file, garment);
  garment.pressed = mesh.pressed;
  const auto& x = garment.rest_positions;
  const auto area_of = [&](int a, int b, int c) { return triangle_area(x[a], x[b], x[c]); };
  garment.masses.assign(x.size(), 0.0);
  for (const auto& t : garment.triangles)
    for (const std::uint32_t corner : t)
      garment.masses[corner] += description.fabric.density * triangle_area(x[t[0]], x[t[1]], x[t[2]]) / 3.0;
  for (const Edge& edge : edges_of(garment.triangles)) {
    double area = area_of(edge.a, edge.b, edge.opposite[0]);
    if (edge.triangles > 1) area += area_of(edge.a, edge.b, edge.opposite[1]);
    const double length = (x[edge.a] - x[edge.b]).norm();
    garment.springs.push_back(
        {edge.a, edge.b, length, description.fabric.stretch * area / (length * length), SpringKind::structural});
  }
  garment.structural_count = static_cast<int>(garment.springs.size());
}

} // namespace tutu::cloth
