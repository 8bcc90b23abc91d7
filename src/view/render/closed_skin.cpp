#include "src/view/render/closed_skin.h"

#include <algorithm>
#include <cstdint>

namespace tutu::app {
namespace {

struct Edge {
  std::uint64_t key;      // the same in both directions
  std::uint32_t from, to; // as its triangle runs, counter-clockwise
};

Edge make_edge(std::uint32_t from, std::uint32_t to) {
  return {(std::uint64_t{std::min(from, to)} << 32) | std::max(from, to), from, to};
}

} // namespace

std::vector<rig::Triangle> closed_skin(std::span<const rig::Triangle> triangles, std::uint32_t vertex_count) {
  std::vector<rig::Triangle> skin(triangles.begin(), triangles.end());
  std::vector<Edge> edges;
  skin.reserve(2 * triangles.size());
  edges.reserve(3 * triangles.size());
  for (const rig::Triangle& t : triangles) {
    skin.push_back({t[0] + vertex_count, t[2] + vertex_count, t[1] + vertex_count});
    for (std::size_t i = 0; i < 3; ++i) edges.push_back(make_edge(t[i], t[(i + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key < b.key; });
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t next = i + 1;
    while (next < edges.size() && edges[next].key == edges[i].key) ++next;
    if (next == i + 1) {
      const auto [key, from, to] = edges[i];
      skin.push_back({from + vertex_count, to + vertex_count, to});
      skin.push_back({from + vertex_count, to, from});
    }
    i = next;
  }
  return skin;
}

} // namespace tutu::app
