#include "proxies/body/detail/mesh_topology.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace tutu::proxies {
namespace {

struct HalfEdge {
  std::uint32_t low, high; // places
  int triangle;
  bool rises; // the triangle runs from low to high
};

/// vertex -> place, numbered by first appearance.
std::vector<std::uint32_t> weld(std::span<const Vec3f> positions, int& places) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) { return std::array{positions[v].x(), positions[v].y(), positions[v].z()}; };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> first(positions.size()), place(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
  places = 0;
  for (std::size_t v = 0; v < positions.size(); ++v)
    place[v] = first[v] == v ? static_cast<std::uint32_t>(places++) : place[first[v]];
  return place;
}

bool has_edges(const rig::Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

std::vector<HalfEdge> half_edges(std::span<const rig::Triangle> corners) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * corners.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    if (!has_edges(corners[t])) continue;
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t from = corners[t][e], to = corners[t][(e + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), static_cast<int>(t), from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::array{a.low, a.high, static_cast<std::uint32_t>(a.triangle)} <
           std::array{b.low, b.high, static_cast<std::uint32_t>(b.triangle)};
  });
  return edges;
}

/// Who is in one set with whom, and whether the same way round: union-find [Tarjan 1975] with parity.
class Sets {
public:
  explicit Sets(std::size_t count) : parent_(count), flipped_(count, false) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// The set's root, and whether `i` runs against it.
  std::pair<int, bool> find(int i) {
    int root = i;
    bool flip = false;
    while (parent_[root] != root) flip ^= flipped_[root], root = parent_[root];
    for (bool rest = flip; parent_[i] != i && parent_[i] != root;) {
      const int next = parent_[i];
      const bool own = flipped_[i];
      parent_[i] = root;
      flipped_[i] = rest;
      rest ^= own;
      i = next;
    }
    return {root, flip};
  }

  /// False where the two are in one set already, and there the other way round.
  bool join(int a, int b, bool against) {
    const auto [root_a, flip_a] = find(a);
    const auto [root_b, flip_b] = find(b);
    if (root_a == root_b) return (flip_a ^ flip_b) == against;
    const int low = std::min(root_a, root_b), high = std::max(root_a, root_b);
    parent_[high] = low;
    flipped_[high] = flip_a ^ flip_b ^ against;
    return true;
  }

private:
  std::vector<int> parent_;
  std::vector<bool> flipped_; // against the parent
};

void find_around(MeshTopology& topology) {
  topology.around_begin.assign(topology.places + 1, 0);
  for (const rig::Triangle& t : topology.corners)
    for (std::size_t c = 0; c < 3; ++c)
      if (has_edges(t)) ++topology.around_begin[t[c] + 1];
  std::partial_sum(topology.around_begin.begin(), topology.around_begin.end(), topology.around_begin.begin());
  topology.around.resize(topology.around_begin.back());
  std::vector<int> next(topology.around_begin.begin(), topology.around_begin.end() - 1);
  for (std::size_t t = 0; t < topology.corners.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      if (has_edges(topology.corners[t])) topology.around[next[topology.corners[t][c]]++] = static_cast<int>(t);
}

void find_shells(MeshTopology& topology, Sets& sets) {
  const std::size_t triangles = topology.corners.size();
  std::vector<int> shell_of_root(triangles, -1);
  topology.shell_of.resize(triangles);
  topology.first_of_shell.assign(1, 0);
  for (std::size_t t = 0; t < triangles; ++t) {
    int& shell = shell_of_root[sets.find(static_cast<int>(t)).first];
    if (shell < 0) {
      shell = topology.shells();
      topology.first_of_shell.push_back(0);
    }
    topology.shell_of[t] = shell;
    ++topology.first_of_shell[shell + 1];
  }
  std::partial_sum(topology.first_of_shell.begin(), topology.first_of_shell.end(), topology.first_of_shell.begin());
  std::vector<int> next(topology.first_of_shell.begin(), topology.first_of_shell.end() - 1);
  topology.by_shell.resize(triangles);
  for (std::size_t t = 0; t < triangles; ++t) topology.by_shell[next[topology.shell_of[t]]++] = static_cast<int>(t);
}

void find_turned(MeshTopology& topology, Sets& patches) {
  const std::size_t triangles = topology.corners.size();
  std::vector<int> balance(triangles, 0); // of a patch's root: triangles with it less those against
  topology.turned.resize(triangles);
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto [root, flip] = patches.find(static_cast<int>(t));
    topology.turned[t] = flip;
    balance[root] += flip ? -1 : 1;
  }
  for (std::size_t t = 0; t < triangles; ++t)
    if (balance[patches.find(static_cast<int>(t)).first] < 0) topology.turned[t] = !topology.turned[t];
}

/// Triangles at a place that share an edge there are one fan.
bool is_pinched(const MeshTopology& topology, std::uint32_t place) {
  const std::span<const int> triangles = topology.at(place);
  if (triangles.size() < 2) return false;
  std::vector<int> fan = {triangles[0]};
  for (std::size_t i = 0; i < fan.size(); ++i)
    for (const int other : triangles) {
      if (std::find(fan.begin(), fan.end(), other) != fan.end()) continue;
      std::ptrdiff_t shared = 0;
      for (const std::uint32_t corner : topology.corners[other])
        shared += std::ranges::count(topology.corners[fan[i]], corner);
      if (shared >= 2) fan.push_back(other);
    }
  return fan.size() < triangles.size();
}

} // namespace

MeshTopology find_topology(std::span<const Vec3f> bind_positions, std::span<const rig::Triangle> triangles) {
  MeshTopology topology;
  const std::vector<std::uint32_t> place = weld(bind_positions, topology.places);
  for (const rig::Triangle& t : triangles) topology.corners.push_back({place[t[0]], place[t[1]], place[t[2]]});
  find_around(topology);

  const std::vector<HalfEdge> edges = half_edges(topology.corners);
  Sets shells(triangles.size()), patches(triangles.size());
  std::vector<int> not_joined, twisted; // triangles with an edge that does not join two, or joins them to one side
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t next = i + 1;
    for (; next < edges.size() && edges[next].low == edges[i].low && edges[next].high == edges[i].high; ++next)
      shells.join(edges[i].triangle, edges[next].triangle, false);
    const bool joins_two = next == i + 2;
    const bool one_sided =
        joins_two && !patches.join(edges[i].triangle, edges[i + 1].triangle, edges[i].rises == edges[i + 1].rises);
    topology.open_edges += next == i + 1;
    topology.nonmanifold_edges += next > i + 2;
    topology.one_sided_edges += one_sided;
    if (!joins_two) not_joined.push_back(edges[i].triangle);
    if (one_sided) twisted.push_back(edges[i].triangle);
    i = next;
  }
  find_shells(topology, shells);
  topology.closed.assign(topology.shells(), true);
  topology.one_sided.assign(topology.shells(), false);
  for (const int t : not_joined) topology.closed[topology.shell_of[t]] = false;
  for (const int t : twisted) topology.one_sided[topology.shell_of[t]] = true;
  find_turned(topology, patches);
  for (std::uint32_t p = 0; p < static_cast<std::uint32_t>(topology.places); ++p)
    topology.pinched_vertices += is_pinched(topology, p);
  return topology;
}

} // namespace tutu::proxies
