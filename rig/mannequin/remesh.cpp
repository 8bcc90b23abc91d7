// Even triangles by local operations, after [Botsch and Kobbelt 2004]: collapse, split, flip, shift, project.
#include "rig/mannequin/detail/parts.h"

#include <algorithm>
#include <cmath>

namespace tutu::rig {
namespace {

constexpr std::uint32_t k_none = 0xffffffffu;
constexpr double k_longest = 4.0 / 3.0,
                 k_shortest = 4.0 / 5.0; ///< of the wanted length, before an edge is split or collapsed

/// A handful of indices without the heap: what is around one vertex.
class Few {
public:
  static constexpr std::size_t k_most = 64; ///< no vertex gets near to it: see can_collapse

  void push_back(std::uint32_t value) { values_[count_++] = value; }
  std::size_t size() const { return count_; }
  const std::uint32_t* begin() const { return values_.data(); }
  const std::uint32_t* end() const { return values_.data() + count_; }
  std::uint32_t operator[](std::size_t i) const { return values_[i]; }
  bool contains(std::uint32_t value) const { return std::find(begin(), end(), value) != end(); }

private:
  std::array<std::uint32_t, k_most> values_;
  std::size_t count_ = 0;
};

Vec3 gradient(const Vec3& p) {
  constexpr double k_step = 2e-5; // m; far below any feature, far above rounding
  // The volumes are told for x >= 0 only; in the mirror plane the slope along x is that of the left side.
  const double lower = std::min(k_step, p.x());
  const Vec3 y(0.0, k_step, 0.0), z(0.0, 0.0, k_step);
  return {(body_distance(p + Vec3(k_step, 0.0, 0.0)) - body_distance(p - Vec3(lower, 0.0, 0.0))) / (k_step + lower),
          (body_distance(p + y) - body_distance(p - y)) / (2.0 * k_step),
          (body_distance(p + z) - body_distance(p - z)) / (2.0 * k_step)};
}

class Remesher {
public:
  explicit Remesher(HalfSurface& half) : positions_(half.positions), triangles_(half.triangles) {
    around_.resize(positions_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (const std::uint32_t v : triangles_[t]) around_[v].push_back(t);
    for (Vec3& p : positions_) {
      on_plane_.push_back(p.x() < 1e-9);
      if (on_plane_.back()) p.x() = 0.0;
    }
  }

  void measure(double scale) {
    wanted_.resize(positions_.size());
    for (std::size_t v = 0; v < positions_.size(); ++v) wanted_[v] = scale * edge_length(positions_[v]);
  }

  void collapse_short() {
    for (std::uint32_t a = 0; a < positions_.size(); ++a) {
      while (!around_[a].empty()) {
        // The shortest edge first, so that what is left is even.
        std::uint32_t best = k_none;
        double shortest = k_shortest * wanted_[a];
        for (const std::uint32_t b : ring(a)) {
          const double length = (positions_[b] - positions_[a]).norm();
          if (length < shortest && can_collapse(a, b)) best = b, shortest = length;
        }
        if (best == k_none) break;
        collapse(a, best);
      }
    }
  }

  void split_long() {
    for (std::uint32_t a = 0; a < positions_.size(); ++a)
      for (const std::uint32_t b : ring(a))
        if (a < b && (positions_[b] - positions_[a]).norm() > k_longest * 0.5 * (wanted_[a] + wanted_[b])) split(a, b);
  }

  void flip_to_even_valence() {
    for (std::uint32_t a = 0; a < positions_.size(); ++a)
      for (const std::uint32_t b : ring(a))
        if (a < b) try_flip(a, b);
  }

  /// Every vertex to the middle of its neighbours along the skin, then onto it.
  void shift() {
    std::vector<Vec3> moved = positions_;
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
      if (around_[v].empty()) continue;
      Vec3 sum = Vec3::Zero();
      double weight = 0.0;
      for (const std::uint32_t b : ring(v)) {
        if (on_plane_[v] && !(on_plane_[b] && shared(v, b).size() == 1)) continue;
        const double w = 1.0 / wanted_[b]; // keeps short edges short beside long ones
        sum += w * positions_[b];
        weight += w;
      }
      Vec3 n = Vec3::Zero();
      for (const std::uint32_t t : around_[v]) n += area_normal(triangles_[t]);
      if (on_plane_[v]) n.x() = 0.0;
      n.normalize();
      Vec3 step = sum / weight - positions_[v];
      step -= n.dot(step) * n;
      moved[v] = positions_[v] + 0.7 * step;
      if (on_plane_[v]) moved[v].x() = 0.0;
      moved[v].x() = std::max(moved[v].x(), 0.0);
    }
    positions_ = moved;
    project(1);
  }

  /// Newton steps along the gradient.
  void project(int steps) {
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
      if (around_[v].empty()) continue;
      Vec3& p = positions_[v];
      for (int i = 0; i < steps; ++i) {
        Vec3 g = gradient(p);
        if (on_plane_[v]) g.x() = 0.0;
        const Vec3 step = body_distance(p) / std::max(g.squaredNorm(), 0.1) * g;
        const double length = step.norm();
        p -= length > 0.003 ? Vec3(0.003 / length * step) : step;
        p.x() = std::max(p.x(), on_plane_[v] ? 0.0 : 1e-4);
      }
    }
  }

  /// Leaves out what was collapsed.
  void compact(HalfSurface& half) const {
    HalfSurface kept;
    std::vector<std::uint32_t> index(positions_.size(), k_none);
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      if (around_[v].empty()) continue;
      index[v] = static_cast<std::uint32_t>(kept.positions.size());
      kept.positions.push_back(positions_[v]);
    }
    for (const Triangle& t : triangles_)
      if (t[0] != k_none) kept.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
    half = std::move(kept);
  }

private:
  /// Neighbours of a vertex, each once.
  Few ring(std::uint32_t v) const {
    Few all;
    for (const std::uint32_t t : around_[v])
      for (const std::uint32_t b : triangles_[t])
        if (b != v && !all.contains(b)) all.push_back(b);
    return all;
  }

  /// Triangles of the edge a, b.
  Few shared(std::uint32_t a, std::uint32_t b) const {
    Few both;
    for (const std::uint32_t t : around_[a])
      if (std::find(triangles_[t].begin(), triangles_[t].end(), b) != triangles_[t].end()) both.push_back(t);
    return both;
  }

  std::uint32_t opposite(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t v : triangles_[t])
      if (v != a && v != b) return v;
    return k_none;
  }

  Vec3 area_normal(const Triangle& t) const {
    return (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]);
  }

  Vec3 merged_place(std::uint32_t a, std::uint32_t b) const {
    if (on_plane_[a] != on_plane_[b]) return positions_[on_plane_[a] ? a : b];
    return 0.5 * (positions_[a] + positions_[b]);
  }

  bool can_collapse(std::uint32_t a, std::uint32_t b) const {
    const Few both = shared(a, b);
    if (on_plane_[a] && on_plane_[b] && both.size() != 1) return false; // would pinch the loop
    const Few ring_a = ring(a), ring_b = ring(b);
    if (ring_a.size() + ring_b.size() > Few::k_most / 2) return false;
    std::size_t common = 0;
    for (const std::uint32_t v : ring_b)
      if (ring_a.contains(v)) ++common;
    if (common != both.size()) return false; // link condition [Dey et al. 1999]
    const Vec3 place = merged_place(a, b);
    for (const Few* side : {&ring_a, &ring_b})
      for (const std::uint32_t v : *side)
        if ((positions_[v] - place).norm() > k_longest * std::max(wanted_[v], 0.5 * (wanted_[a] + wanted_[b])))
          return false;
    return keeps_facing(a, b, place) && keeps_facing(b, a, place);
  }

  /// Whether the triangles of `v` without `other` look the same way once `v` is at `place`, and stay well shaped.
  bool keeps_facing(std::uint32_t v, std::uint32_t other, const Vec3& place) const {
    for (const std::uint32_t t : around_[v]) {
      const Triangle& corners = triangles_[t];
      if (std::find(corners.begin(), corners.end(), other) != corners.end()) continue;
      std::array<Vec3, 3> p;
      for (int c = 0; c < 3; ++c) p[c] = corners[c] == v ? place : positions_[corners[c]];
      const Vec3 before = area_normal(corners), after = (p[1] - p[0]).cross(p[2] - p[0]);
      if (before.dot(after) < 0.3 * before.norm() * after.norm()) return false;
      const double longest =
          std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
      if (after.norm() < 0.05 * longest) return false;
    }
    return true;
  }

  void drop(std::uint32_t t) {
    for (const std::uint32_t v : triangles_[t]) std::erase(around_[v], t);
    triangles_[t] = {k_none, k_none, k_none};
  }

  void collapse(std::uint32_t a, std::uint32_t b) {
    const Vec3 place = merged_place(a, b);
    for (const std::uint32_t t : shared(a, b)) drop(t);
    for (const std::uint32_t t : around_[b]) {
      for (std::uint32_t& v : triangles_[t])
        if (v == b) v = a;
      around_[a].push_back(t);
    }
    around_[b].clear();
    positions_[a] = place;
    wanted_[a] = 0.5 * (wanted_[a] + wanted_[b]);
    on_plane_[a] = on_plane_[a] || on_plane_[b];
  }

  void split(std::uint32_t a, std::uint32_t b) {
    const auto middle = static_cast<std::uint32_t>(positions_.size());
    const Few both = shared(a, b);
    positions_.push_back(0.5 * (positions_[a] + positions_[b]));
    on_plane_.push_back(both.size() == 1);
    wanted_.push_back(0.5 * (wanted_[a] + wanted_[b]));
    around_.emplace_back();
    for (const std::uint32_t t : both) {
      Triangle half = triangles_[t];
      std::replace(half.begin(), half.end(), a, middle);
      std::replace(triangles_[t].begin(), triangles_[t].end(), b, middle);
      const auto added = static_cast<std::uint32_t>(triangles_.size());
      triangles_.push_back(half);
      std::erase(around_[b], t);
      around_[middle].push_back(t);
      for (const std::uint32_t v : half) around_[v].push_back(added);
    }
  }

  /// How far from six (four on the rim) the number of neighbours is, squared.
  double unevenness(std::uint32_t v, int change) const {
    const int d = static_cast<int>(around_[v].size()) + (on_plane_[v] ? 1 : 0) + change - (on_plane_[v] ? 4 : 6);
    return d * d;
  }

  void try_flip(std::uint32_t a, std::uint32_t b) {
    const Few both = shared(a, b);
    if (both.size() != 2) return;
    const std::uint32_t c = opposite(both[0], a, b), d = opposite(both[1], a, b);
    if (on_plane_[c] && on_plane_[d]) return;
    const Few ring_c = ring(c);
    if (ring_c.contains(d)) return;
    const double before = unevenness(a, 0) + unevenness(b, 0) + unevenness(c, 0) + unevenness(d, 0);
    const double after = unevenness(a, -1) + unevenness(b, -1) + unevenness(c, 1) + unevenness(d, 1);
    if (after >= before) return;
    Triangle first = triangles_[both[0]], second = triangles_[both[1]]; // a c d and b c d, each turned as before
    std::replace(first.begin(), first.end(), b, d);
    std::replace(second.begin(), second.end(), a, c);
    const Vec3 n = (area_normal(triangles_[both[0]]) + area_normal(triangles_[both[1]])).normalized();
    for (const Triangle& t : {first, second}) {
      const Vec3 area = area_normal(t);
      const double longest = std::max({(positions_[t[1]] - positions_[t[0]]).squaredNorm(),
                                       (positions_[t[2]] - positions_[t[1]]).squaredNorm(),
                                       (positions_[t[0]] - positions_[t[2]]).squaredNorm()});
      if (area.dot(n) < 0.85 * area.norm() || area.norm() < 0.2 * longest) return;
    }
    triangles_[both[0]] = first;
    triangles_[both[1]] = second;
    std::erase(around_[b], both[0]);
    std::erase(around_[a], both[1]);
    around_[d].push_back(both[0]);
    around_[c].push_back(both[1]);
  }

  std::vector<Vec3> positions_;
  std::vector<Triangle> triangles_;                ///< k_none thrice where dropped
  std::vector<std::vector<std::uint32_t>> around_; ///< triangles of each vertex; empty where collapsed
  std::vector<bool> on_plane_;
  std::vector<double> wanted_; ///< edge length about each vertex, m
};

} // namespace

void remesh_body(HalfSurface& half) {
  {
    Remesher coarser(half); // most of the fine vertices go before anything costly is asked of the rest
    coarser.measure(0.75);
    coarser.collapse_short();
    coarser.compact(half);
  }
  Remesher remesher(half);
  remesher.measure(1.0);
  remesher.project(1);
  constexpr int k_rounds = 5;
  for (int round = 0; round < k_rounds; ++round) {
    remesher.split_long();
    remesher.collapse_short();
    remesher.flip_to_even_valence();
    remesher.shift();
    remesher.measure(1.0);
  }
  remesher.flip_to_even_valence();
  for (int i = 0; i < 3; ++i) remesher.shift();
  remesher.project(4);
  remesher.compact(half);
}

} // namespace tutu::rig
