#include "cloth/garment/elements.h"

#include "cloth/garment/dihedral.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

namespace tutu::cloth {
namespace {

/// For each particle the particles it is joined to, and how far they are at rest.
using Ways = std::vector<std::vector<std::pair<int, double>>>;

Ways ways_of(const Garment& garment) {
  Ways ways(garment.rest_positions.size());
  const auto join = [&](int i, int j) {
    const double length = (garment.rest_positions[i] - garment.rest_positions[j]).norm();
    ways[i].emplace_back(j, length);
    ways[j].emplace_back(i, length);
  };
  for (const Edge& edge : edges_of(garment.triangles)) join(edge.a, edge.b);
  for (const Spring& spring : garment.springs)
    if (spring.kind == SpringKind::shear) join(spring.i, spring.j); // the diagonals that no triangle has
  for (const Seam& seam : garment.seams) {
    ways[seam.i].emplace_back(seam.j, 0.0);
    ways[seam.j].emplace_back(seam.i, 0.0);
  }
  return ways;
}

} // namespace

std::vector<Edge> edges_of(std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<Edge> sides;
  sides.reserve(3 * triangles.size());
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const int i = static_cast<int>(t[k]), j = static_cast<int>(t[(k + 1) % 3]);
      sides.push_back({std::min(i, j), std::max(i, j), 1, {static_cast<int>(t[(k + 2) % 3]), -1}});
    }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Edge& x, const Edge& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  std::vector<Edge> edges;
  for (const Edge& side : sides) {
    if (edges.empty() || edges.back().a != side.a || edges.back().b != side.b) {
      edges.push_back(side);
      continue;
    }
    if (++edges.back().triangles == 2) edges.back().opposite[1] = side.opposite[0];
  }
  return edges;
}

std::vector<Bend> build_bends(const Garment& garment) {
  std::vector<Bend> bends;
  if (!(garment.fabric.bend > 0.0)) return bends;
  for (const Edge& edge : edges_of(garment.triangles)) {
    if (edge.triangles != 2) continue;
    Bend bend{edge.a, edge.b, edge.opposite[0], edge.opposite[1]};
    const auto& x = garment.rest_positions;
    const double area = triangle_area(x[bend.a], x[bend.b], x[bend.c]) + triangle_area(x[bend.a], x[bend.b], x[bend.d]);
    bend.stiffness = garment.fabric.bend * (x[bend.a] - x[bend.b]).squaredNorm() / area;
    if (garment.pressed) bend.rest_angle = dihedral<double>(x[bend.a], x[bend.b], x[bend.c], x[bend.d]).angle();
    bends.push_back(bend);
  }
  return bends;
}

std::vector<Tether> build_tethers(const Garment& garment) {
  // Dijkstra from all pinned particles at once; of two ways of one length the one to the lower anchor counts.
  struct Reached {
    double length;
    int anchor, particle;
    auto operator<=>(const Reached&) const = default;
  };
  const Ways ways = ways_of(garment);
  std::vector<double> length(ways.size(), std::numeric_limits<double>::infinity());
  std::vector<int> anchor(ways.size(), -1);
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  const auto reach = [&](int particle, int from, double way) {
    if (way > length[particle] || (way == length[particle] && from >= anchor[particle])) return;
    length[particle] = way;
    anchor[particle] = from;
    open.push({way, from, particle});
  };
  for (const Pin& pin : garment.pins) reach(pin.particle, pin.particle, 0.0);
  while (!open.empty()) {
    const Reached nearest = open.top();
    open.pop();
    if (nearest.length > length[nearest.particle] || nearest.anchor != anchor[nearest.particle]) continue;
    for (const auto& [next, step] : ways[nearest.particle]) reach(next, nearest.anchor, nearest.length + step);
  }
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  std::vector<Tether> tethers;
  for (int i = 0; i < garment.particle_count(); ++i)
    if (anchor[i] >= 0 && !pinned[i]) tethers.push_back({i, anchor[i], length[i]});
  return tethers;
}

double longest_of(const Tether& tether, const Fabric& fabric) {
  constexpr double k_give = 0.02;       // less would hold threads that a finer substep would not stretch
  constexpr double k_load = 3.0 * 9.81; // m/s2: a dancer's turn takes cloth to about 2 g on top of its weight
  return tether.length * (1.0 + k_give + k_load * fabric.density / fabric.stretch * tether.length);
}

} // namespace tutu::cloth
