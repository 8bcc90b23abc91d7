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
  explicit JoinedSets(int count) : above_(count) { std::iota(above_.begin(), above_.end(), 0); }

  void join(int i, int j) {
    i = top(i);
    j = top(j);
    above_[std::max(i, j)] = std::min(i, j);
  }
  int top(int i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }

private:
  std::vector<int> above_;
};

struct Edge {
  std::uint32_t i, j;
  int first, count; ///< of Parts::owners
  bool placed;
};

} // namespace

/// A surface taken apart: what is counted of it, every edge once.
struct CrossingSurface::Parts {
  std::vector<Vec3> positions;
  std::vector<std::uint8_t> there; ///< [vertex]
  std::vector<rig::Triangle> triangles;
  std::vector<int> given; ///< [triangle]: its index in what was given
  std::vector<std::uint8_t> placed_triangles;
  std::vector<Edge> edges;
  std::vector<int> owners; ///< the triangles of each edge
  std::vector<Box> boxes;  ///< [triangle]; empty where a corner is not there
  BoxTree tree{{}};

  bool is_there(int triangle) const { return !boxes[triangle].isEmpty(); }
  void find_edges(std::span<const std::uint8_t> placed);
  void put(std::span<const Vec3> at);
};

void CrossingSurface::Parts::find_edges(std::span<const std::uint8_t> placed) {
  std::vector<std::array<std::uint32_t, 3>> sides; // lower end, upper end, triangle
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [i, j] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      sides.push_back({i, j, static_cast<std::uint32_t>(t)});
    }
  std::sort(sides.begin(), sides.end());
  for (const auto& [i, j, t] : sides) {
    if (edges.empty() || edges.back().i != i || edges.back().j != j)
      edges.push_back({i, j, static_cast<int>(owners.size()), 0, placed[i] && placed[j]});
    ++edges.back().count;
    owners.push_back(static_cast<int>(t));
  }
}

void CrossingSurface::Parts::put(std::span<const Vec3> at) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::optional<Vec3> place = exact_place(at[i]);
    there[i] = place.has_value();
    positions[i] = place.value_or(Vec3::Zero());
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    boxes[t].setEmpty();
    if (!there[a] || !there[b] || !there[c]) continue;
    boxes[t].extend(positions[a]).extend(positions[b]).extend(positions[c]);
  }
}

CrossingSurface::CrossingSurface(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles,
                                 std::span<const std::pair<int, int>> sewn, std::span<const std::uint8_t> placed)
    : parts_(std::make_unique<Parts>()) {
  Parts& parts = *parts_;
  JoinedSets vertices(static_cast<int>(positions.size()));
  for (const auto& [i, j] : sewn) vertices.join(i, j);
  std::vector<std::uint8_t> is_placed(positions.size());
  for (std::size_t i = 0; i < placed.size(); ++i) is_placed[vertices.top(static_cast<int>(i))] |= placed[i];
  for (std::size_t given = 0; given < triangles.size(); ++given) {
    rig::Triangle t;
    for (int k = 0; k < 3; ++k) t[k] = static_cast<std::uint32_t>(vertices.top(static_cast<int>(triangles[given][k])));
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    parts.triangles.push_back(t);
    parts.given.push_back(static_cast<int>(given));
    parts.placed_triangles.push_back(is_placed[t[0]] && is_placed[t[1]] && is_placed[t[2]]);
  }
  parts.find_edges(is_placed);
  parts.positions.resize(positions.size());
  parts.there.resize(positions.size());
  parts.boxes.resize(parts.triangles.size());
  parts.put(positions);
  parts.tree = BoxTree(parts.boxes);
}

CrossingSurface::~CrossingSurface() = default;
CrossingSurface::CrossingSurface(CrossingSurface&&) noexcept = default;
CrossingSurface& CrossingSurface::operator=(CrossingSurface&&) noexcept = default;

void CrossingSurface::move(std::span<const Vec3> positions) {
  parts_->put(positions);
  parts_->tree.refit(parts_->boxes);
}

void CrossingSurface::touching(const Box& box, std::vector<int>& found) const {
  const std::size_t before = found.size();
  parts_->tree.touching(box, found);
  for (std::size_t k = before; k < found.size(); ++k) found[k] = parts_->given[found[k]];
}

namespace {

using Parts = CrossingSurface::Parts;

/// A pair seen from one of the edge's triangles: that and the triangle gone through.
struct Meeting {
  int one, other; ///< triangles
  int pair;
  auto operator<=>(const Meeting&) const = default;
};

struct Meetings {
  std::vector<Meeting> all;
  std::vector<std::uint8_t> placed; ///< [pair]
};

bool neighbours(const Edge& edge, const rig::Triangle& t) {
  return std::any_of(t.begin(), t.end(), [&](std::uint32_t corner) { return corner == edge.i || corner == edge.j; });
}

/// All pairs of an edge of `a` and a triangle of `b`. `add` is told both triangles of each meeting, a's first.
template <class Add>
void find_pairs(const Parts& a, const Parts& b, Beside beside, bool same, Meetings& meetings, const Add& add) {
  std::vector<int> near;
  for (const Edge& edge : a.edges) {
    if (!a.there[edge.i] || !a.there[edge.j]) continue;
    const Vec3 &p = a.positions[edge.i], &q = a.positions[edge.j];
    near.clear();
    b.tree.touching(Box(p.cwiseMin(q), p.cwiseMax(q)), near);
    for (const int t : near) {
      const rig::Triangle& corners = b.triangles[t];
      if (same && neighbours(edge, corners)) continue;
      if (!passage_through(p, q, b.positions[corners[0]], b.positions[corners[1]], b.positions[corners[2]], beside))
        continue;
      const int pair = static_cast<int>(meetings.placed.size());
      const std::size_t before = meetings.all.size();
      for (int k = 0; k < edge.count; ++k)
        if (const int owner = a.owners[edge.first + k]; a.is_there(owner)) add(owner, t, pair);
      if (meetings.all.size() > before) meetings.placed.push_back(edge.placed && b.placed_triangles[t]);
    }
  }
}

/// Pairs of the same two triangles belong together.
SurfaceCrossings linked(Meetings& meetings) {
  const int pairs = static_cast<int>(meetings.placed.size());
  JoinedSets curves(pairs);
  std::sort(meetings.all.begin(), meetings.all.end());
  for (std::size_t k = 1; k < meetings.all.size(); ++k) {
    const Meeting &before = meetings.all[k - 1], &now = meetings.all[k];
    if (before.one == now.one && before.other == now.other) curves.join(before.pair, now.pair);
  }
  SurfaceCrossings found{pairs, 0, 0};
  std::vector<std::uint8_t> placed(meetings.placed.size()); // of the top of each curve
  for (int pair = 0; pair < pairs; ++pair) placed[curves.top(pair)] |= meetings.placed[pair];
  for (int pair = 0; pair < pairs; ++pair)
    if (curves.top(pair) == pair) ++(placed[pair] ? found.placed : found.crossings);
  return found;
}

} // namespace

SurfaceCrossings crossings_between(const CrossingSurface& one, const CrossingSurface& other) {
  Meetings meetings;
  find_pairs(one.parts(), other.parts(), Beside::behind, false, meetings, [&](int of_one, int of_other, int pair) {
    meetings.all.push_back({of_one, of_other, pair});
  });
  find_pairs(other.parts(), one.parts(), Beside::before, false, meetings, [&](int of_other, int of_one, int pair) {
    meetings.all.push_back({of_one, of_other, pair});
  });
  return linked(meetings);
}

SurfaceCrossings crossings_within(const CrossingSurface& surface) {
  Meetings meetings;
  find_pairs(surface.parts(), surface.parts(), Beside::behind, true, meetings, [&](int s, int t, int pair) {
    meetings.all.push_back({std::min(s, t), std::max(s, t), pair});
  });
  return linked(meetings);
}

} // namespace tutu::proxies
