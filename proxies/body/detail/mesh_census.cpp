#include "proxies/body/detail/mesh_census.h"

#include "proxies/body/detail/solid_angle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace tutu::proxies {
namespace {

constexpr double k_flat = 1e-10; ///< a triangle's area as a share of its longest edge squared: at most that is none
/// A body's volume as a share of area^1.5 (a sphere has 0.094, a sheet 0): below it encloses nothing.
constexpr double k_least_volume = 1e-5;
/// So large a share of area or volume may be turned over before the mesh is refused: an eye, not a limb.
constexpr double k_turned_share = 0.01;
constexpr double k_off_surface = 1e-6; ///< how far off a triangle its sides are looked at, as a share of sqrt(area)
constexpr std::size_t k_shell_samples = 256; ///< vertices of a shell that are asked whether others hold it

constexpr const char* k_outward = "triangles that run counter-clockwise seen from outside: recalculate its normals to "
                                  "the outside where it was modelled";

[[noreturn]] void refuse(const std::string& found, const std::string& expected) {
  throw std::invalid_argument("body mesh: found " + found + ", expected " + expected);
}

std::string count_of(int count, const char* one, const char* many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

std::string percent(double share) {
  const int tenths = static_cast<int>(std::lround(1000.0 * share));
  return std::to_string(tenths / 10) + '.' + std::to_string(tenths % 10) + " %";
}

struct Measures {
  double area = 0.0, turned_area = 0.0, volume = 0.0;
  int flat = 0;
};

class Mesh {
public:
  Mesh(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles) : p_(positions), t_(triangles) {}

  const Vec3& corner(int triangle, std::size_t c) const { return p_[t_[triangle][c]]; }

  /// Volume by the divergence theorem about the shell's middle, so that an opening is closed from there.
  Measures measure(const MeshTopology& topology, int shell) const {
    Measures sum;
    Vec3 middle = Vec3::Zero();
    for (const int t : topology.shell(shell)) {
      const Vec3 ab = corner(t, 1) - corner(t, 0), ac = corner(t, 2) - corner(t, 0);
      const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
      const double area = 0.5 * ab.cross(ac).norm();
      sum.flat += area <= k_flat * longest;
      sum.area += area;
      if (topology.turned[t]) sum.turned_area += area;
      middle += area / 3.0 * (corner(t, 0) + corner(t, 1) + corner(t, 2));
    }
    if (!(sum.area > 0.0)) return sum;
    middle /= sum.area;
    for (const int t : topology.shell(shell))
      sum.volume += (corner(t, 0) - middle).dot((corner(t, 1) - middle).cross(corner(t, 2) - middle)) / 6.0;
    return sum;
  }

  /// Whether all of a shell's vertices (some of them, where there are many) are inside the other shells. What the
  /// shell itself adds to the winding number at its own vertices is taken off.
  bool is_inner(const MeshTopology& topology, int shell, const std::function<double(const Vec3&)>& winding) const {
    const std::span<const int> own = topology.shell(shell);
    const std::size_t step = (own.size() + k_shell_samples - 1) / k_shell_samples;
    for (std::size_t i = 0; i < own.size(); i += step) {
      const Vec3& vertex = corner(own[i], 0);
      double others = winding(vertex);
      for (const int t : own) others -= winding_of(vertex, corner(t, 0), corner(t, 1), corner(t, 2));
      if (others <= 0.5) return false;
    }
    return true;
  }

  /// Triangles whose outer side is inside: where a closed shell passes through itself.
  int buried(double height, const std::function<double(const Vec3&)>& winding) const {
    int count = 0;
    for (int t = 0; t < static_cast<int>(t_.size()); ++t) {
      const Vec3 normal = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).normalized();
      count += winding((corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0 + height * normal) > 0.5;
    }
    return count;
  }

private:
  std::span<const Vec3> p_;
  std::span<const rig::Triangle> t_;
};

void choose_rule(MeshCensus& census) {
  std::string why;
  const auto add = [&](int count, const char* one, const char* many) {
    if (count > 0) why += (why.empty() ? "" : ", ") + count_of(count, one, many);
  };
  if (census.shells > 1) add(census.shells, "shell", "shells");
  add(census.inner_shells, "of them inside the others", "of them inside the others");
  add(census.inverted_shells, "of them inside out", "of them inside out");
  add(census.open_edges, "open edge", "open edges");
  add(census.nonmanifold_edges, "edge of more than two triangles", "edges of more than two triangles");
  add(census.pinched_vertices, "pinched vertex", "pinched vertices");
  add(census.turned_triangles, "triangle turned over", "triangles turned over");
  add(census.flat_triangles, "triangle without area", "triangles without area");
  census.rule = why.empty() ? SideRule::pseudonormal : SideRule::winding_number;
  census.reason = why.empty() ? "one closed shell, all of its triangles the same way round" : why;
}

} // namespace

void require_usable_mesh(std::span<const Vec3f> positions, std::span<const rig::Triangle> triangles) {
  if (triangles.empty()) refuse("no triangle", "a surface");
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (!positions[v].allFinite()) refuse("vertex " + std::to_string(v) + " at no finite place", "finite positions");
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::uint32_t v : triangles[t])
      if (v >= positions.size())
        refuse("vertex " + std::to_string(v) + " in triangle " + std::to_string(t),
               "indices below " + std::to_string(positions.size()));
}

MeshFindings take_census(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles,
                         const MeshTopology& topology, const std::function<double(const Vec3&)>& winding) {
  const Mesh mesh(positions, triangles);
  MeshFindings found;
  MeshCensus& census = found.census;
  census.vertices = static_cast<int>(positions.size());
  census.triangles = static_cast<int>(triangles.size());
  census.welded_vertices = topology.places;
  census.shells = topology.shells();
  census.open_edges = topology.open_edges;
  census.nonmanifold_edges = topology.nonmanifold_edges;
  census.pinched_vertices = topology.pinched_vertices;
  census.turned_triangles = static_cast<int>(std::ranges::count(topology.turned, true));

  double turned_area = 0.0, inverted_volume = 0.0, enclosed = 0.0;
  found.inner.resize(census.shells);
  for (int s = 0; s < census.shells; ++s) {
    const Measures shell = mesh.measure(topology, s);
    census.area += shell.area;
    census.volume += shell.volume;
    census.flat_triangles += shell.flat;
    turned_area += shell.turned_area;
    enclosed += std::abs(shell.volume);
    found.inner[s] = census.shells > 1 && mesh.is_inner(topology, s, winding);
    census.inner_shells += found.inner[s];
    if (found.inner[s] || shell.volume >= 0.0) continue;
    ++census.inverted_shells;
    inverted_volume -= shell.volume;
  }

  if (!(census.area > 0.0)) refuse("no triangle with an area", "a surface");
  if (topology.one_sided_edges > 0)
    refuse("a one-sided surface", "a body: take out what hangs on it by one edge or twists back onto itself");
  if (turned_area > k_turned_share * census.area)
    refuse(percent(turned_area / census.area) + " of the surface turned over against its neighbours (" +
               count_of(census.turned_triangles, "triangle", "triangles") + ')',
           k_outward);
  if (enclosed <= k_least_volume * std::pow(census.area, 1.5))
    refuse("a surface that encloses nothing", "a body: give it thickness, or delete the one of doubled triangles");
  if (census.volume < 0.0) refuse("a body turned inside out", k_outward);
  if (inverted_volume > k_turned_share * enclosed)
    refuse(count_of(census.inverted_shells, "shell", "shells") + " with " + percent(inverted_volume / enclosed) +
               " of the volume turned inside out",
           k_outward);
  choose_rule(census);
  if (census.rule == SideRule::winding_number) return found;
  const int buried = mesh.buried(k_off_surface * std::sqrt(census.area), winding);
  if (buried == 0) return found;
  census.rule = SideRule::winding_number;
  census.reason = "one closed shell that passes through itself (" +
                  count_of(buried, "triangle inside the body)", "triangles inside the body)");
  return found;
}

} // namespace tutu::proxies
