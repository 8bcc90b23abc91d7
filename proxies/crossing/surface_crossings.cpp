#include "proxies/crossing/surface_crossings.h"

#include "proxies/crossing/detail/box_tree.h"
#include "proxies/crossing/orientation.h"
#include "proxies/crossing/segment_triangle.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <vector>

namespace tutu::proxies {
namespace {

/// Sets of the numbers below `count`, joined two by two [Tarjan 1975], with halving of paths.
class JoinedSets {
public:
  explicit JoinedSets(int count) : above_(count), sets_(count) { std::iota(above_.begin(), above_.end(), 0); }

  void join(int i, int j) {
    i = top(i);
    j = top(j);
    if (i == j) return;
    above_[std::max(i, j)] = std::min(i, j);
    --sets_;
  }
  int top(int i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }
  int sets() const { return sets_; }

private:
  std::vector<int> above_;
  int sets_;
};

struct Edge {
  std::uint32_t i, j;
  int first, count; ///< of Parts::owners
};

/// A surface taken apart: what is counted of it, every edge once.
struct Parts {
  std::vector<Vec3> positions;
  std::vector<rig::Triangle> triangles;
  std::vector<Edge> edges;
  std::vector<int> owners; ///< the triangles of each edge
};

void find_edges(Parts& parts) {
  std::vector<std::array<std::uint32_t, 3>> sides; // lower end, upper end, triangle
  for (std::size_t t = 0; t < parts.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [i, j] = std::minmax(parts.triangles[t][k], parts.triangles[t][(k + 1) % 3]);
      sides.push_back({i, j, static_cast<std::uint32_t>(t)});
    }
  std::sort(sides.begin(), sides.end());
  for (const auto& [i, j, t] : sides) {
    if (parts.edges.empty() || parts.edges.back().i != i || parts.edges.back().j != j)
      parts.edges.push_back({i, j, static_cast<int>(parts.owners.size()), 0});
    ++parts.edges.back().count;
    parts.owners.push_back(static_cast<int>(t));
  }
}

Parts parts_of(const SurfaceView& surface, std::span<const std::pair<int, int>> sewn) {
  Parts parts;
  JoinedSets vertices(static_cast<int>(surface.positions.size()));
  for (const auto& [i, j] : sewn) vertices.join(i, j);
  std::vector<std::uint8_t> there;
  for (const Vec3& p : surface.positions) {
    const std::optional<Vec3> place = exact_place(p);
    there.push_back(place.has_value());
    parts.positions.push_back(place.value_or(Vec3::Zero()));
  }
  for (const rig::Triangle& triangle : surface.triangles) {
    rig::Triangle t;
    for (int k = 0; k < 3; ++k) t[k] = static_cast<std::uint32_t>(vertices.top(static_cast<int>(triangle[k])));
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || !there[t[0]] || !there[t[1]] || !there[t[2]]) continue;
    parts.triangles.push_back(t);
  }
  find_edges(parts);
  return parts;
}

BoxTree tree_of(const Parts& parts) {
  std::vector<Box> boxes;
  for (const rig::Triangle& t : parts.triangles) {
    Box box(parts.positions[t[0]]);
    box.extend(parts.positions[t[1]]);
    box.extend(parts.positions[t[2]]);
    boxes.push_back(box);
  }
  return BoxTree(boxes);
}

/// A pair seen from one of the edge's triangles: that and the triangle gone through.
struct Meeting {
  int one, other; ///< triangles
  int pair;
  auto operator<=>(const Meeting&) const = default;
};

struct Meetings {
  std::vector<Meeting> all;
  int pairs = 0;
};

bool neighbours(const Edge& edge, const rig::Triangle& t) {
  return std::any_of(t.begin(), t.end(), [&](std::uint32_t corner) { return corner == edge.i || corner == edge.j; });
}

/// All pairs of an edge of `a` and a triangle of `b`. `add` is told both triangles of each meeting, a's first.
template <class Add>
void find_pairs(const Parts& a, const Parts& b, Beside beside, bool same, Meetings& meetings, const Add& add) {
  const BoxTree tree = tree_of(b);
  std::vector<int> near;
  for (const Edge& edge : a.edges) {
    const Vec3 &p = a.positions[edge.i], &q = a.positions[edge.j];
    near.clear();
    tree.touching(Box(p.cwiseMin(q), p.cwiseMax(q)), near);
    for (const int t : near) {
      const rig::Triangle& corners = b.triangles[t];
      if (same && neighbours(edge, corners)) continue;
      if (!passage_through(p, q, b.positions[corners[0]], b.positions[corners[1]], b.positions[corners[2]], beside))
        continue;
      for (int k = 0; k < edge.count; ++k) add(a.owners[edge.first + k], t, meetings.pairs);
      ++meetings.pairs;
    }
  }
}

/// Pairs of the same two triangles belong together.
SurfaceCrossings linked(Meetings& meetings) {
  JoinedSets curves(meetings.pairs);
  std::sort(meetings.all.begin(), meetings.all.end());
  for (std::size_t k = 1; k < meetings.all.size(); ++k) {
    const Meeting &before = meetings.all[k - 1], &now = meetings.all[k];
    if (before.one == now.one && before.other == now.other) curves.join(before.pair, now.pair);
  }
  return {meetings.pairs, curves.sets()};
}

} // namespace

SurfaceCrossings crossings_between(const SurfaceView& one, const SurfaceView& other) {
  const Parts a = parts_of(one, {}), b = parts_of(other, {});
  Meetings meetings;
  find_pairs(a, b, Beside::behind, false, meetings, [&](int of_a, int of_b, int pair) {
    meetings.all.push_back({of_a, of_b, pair});
  });
  find_pairs(b, a, Beside::before, false, meetings, [&](int of_b, int of_a, int pair) {
    meetings.all.push_back({of_a, of_b, pair});
  });
  return linked(meetings);
}

SurfaceCrossings crossings_within(const SurfaceView& surface, std::span<const std::pair<int, int>> sewn) {
  const Parts parts = parts_of(surface, sewn);
  Meetings meetings;
  find_pairs(parts, parts, Beside::behind, true, meetings, [&](int s, int t, int pair) {
    meetings.all.push_back({std::min(s, t), std::max(s, t), pair});
  });
  return linked(meetings);
}

} // namespace tutu::proxies
