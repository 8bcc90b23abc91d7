#include "rig/mannequin/detail/parts.h"

#include <cmath>
#include <limits>
#include <unordered_map>

namespace tutu::rig {
namespace {

constexpr double k_cell = 0.0055;         ///< m; two cells across the slenderest finger
constexpr int k_block = 4;                ///< cells along the edge of a block that is looked at, or passed over, as one
constexpr int k_blocks[3] = {31, 80, 17}; ///< 0.68 x 1.76 x 0.37 m
// Off the round numbers of the volumes, so that no flat sole lies in a plane of the lattice.
const Vec3 k_origin(0.0, -0.01773, -0.17217);

struct Lattice {
  int nodes[3] = {k_blocks[0] * k_block + 1, k_blocks[1] * k_block + 1, k_blocks[2] * k_block + 1};
  std::vector<double> values = std::vector<double>(static_cast<std::size_t>(nodes[0]) * nodes[1] * nodes[2],
                                                   std::numeric_limits<double>::quiet_NaN());

  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(i) * nodes[1] + j) * nodes[2] + k; }
  Vec3 place(std::size_t node) const {
    const auto k = node % nodes[2], j = node / nodes[2] % nodes[1], i = node / nodes[2] / nodes[1];
    return k_origin + k_cell * Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
  }
  double value(std::size_t node) {
    double& f = values[node];
    if (std::isnan(f)) {
      f = body_distance(place(node));
      if (std::abs(f) < 1e-7) f = 1e-7; // never on a node: every crossing lies inside an edge
    }
    return f;
  }
};

/// The six tetrahedra of a cube that share its main diagonal [Kuhn 1960]: corners as bits x = 4, y = 2, z = 1. All have
/// the same handedness after the swap in `k_odd`, and neighbouring cubes agree on their common face.
constexpr int k_tetrahedra[6][4] = {{0, 4, 6, 7}, {0, 4, 5, 7}, {0, 2, 6, 7}, {0, 2, 3, 7}, {0, 1, 5, 7}, {0, 1, 3, 7}};
constexpr bool k_odd[6] = {false, true, true, false, false, true};

} // namespace

HalfSurface march_body() {
  Lattice lattice;
  HalfSurface half;
  std::unordered_map<std::uint64_t, std::uint32_t> crossings; // by lower node and direction of the edge
  crossings.reserve(400000);

  const auto crossing = [&](const std::size_t(&corner)[8], int a, int b) {
    if (a > b) std::swap(a, b); // along Kuhn's tetrahedra the bits of one corner contain those of the other
    const std::uint64_t key = corner[a] * 8 + static_cast<std::uint64_t>(b - a);
    const auto [entry, is_new] = crossings.try_emplace(key, static_cast<std::uint32_t>(half.positions.size()));
    if (is_new) {
      const double fa = lattice.value(corner[a]), fb = lattice.value(corner[b]);
      const Vec3 pa = lattice.place(corner[a]), pb = lattice.place(corner[b]);
      half.positions.push_back(pa + fa / (fa - fb) * (pb - pa));
    }
    return entry->second;
  };

  const auto tetrahedron = [&](const std::size_t(&corner)[8], const int(&t)[4], bool odd) {
    int inside[4], outside[4], n_in = 0, n_out = 0;
    bool flip = odd;
    for (int m = 0; m < 4; ++m) {
      if (lattice.value(corner[t[m]]) < 0.0) {
        inside[n_in++] = m;
        // Moving this corner past the outside ones before it is a permutation of as many swaps.
        if (n_out % 2 == 1) flip = !flip;
      } else {
        outside[n_out++] = m;
      }
    }
    const auto cut = [&](int a, int b) { return crossing(corner, t[inside[a]], t[outside[b]]); };
    // Braces, not parentheses: their order is given, and with it the numbers of the vertices.
    const auto add = [&](const Triangle& c) { half.triangles.push_back(flip ? Triangle{c[0], c[2], c[1]} : c); };
    if (n_in == 1) add({cut(0, 0), cut(0, 1), cut(0, 2)});
    if (n_in == 3) add({cut(0, 0), cut(1, 0), cut(2, 0)});
    if (n_in == 2) {
      add({cut(0, 0), cut(0, 1), cut(1, 1)});
      add({cut(0, 0), cut(1, 1), cut(1, 0)});
    }
  };

  const auto cube = [&](int i, int j, int k) {
    std::size_t corner[8];
    int n_in = 0;
    for (int c = 0; c < 8; ++c) {
      corner[c] = lattice.index(i + (c >> 2), j + (c >> 1 & 1), k + (c & 1));
      if (lattice.value(corner[c]) < 0.0) ++n_in;
    }
    if (n_in == 0 || n_in == 8) return;
    for (int t = 0; t < 6; ++t) tetrahedron(corner, k_tetrahedra[t], k_odd[t]);
  };

  constexpr double k_half_block = 0.5 * k_block * k_cell;
  for (int bi = 0; bi < k_blocks[0]; ++bi) {
    for (int bj = 0; bj < k_blocks[1]; ++bj) {
      for (int bk = 0; bk < k_blocks[2]; ++bk) {
        const Vec3 centre = k_origin + k_half_block * Vec3(2.0 * bi + 1.0, 2.0 * bj + 1.0, 2.0 * bk + 1.0);
        // The half diagonal is sqrt(3) of a half edge; the distances are not exact, so look well beyond it.
        if (std::abs(body_distance(centre)) > 3.0 * k_half_block) continue;
        for (int i = 0; i < k_block; ++i)
          for (int j = 0; j < k_block; ++j)
            for (int k = 0; k < k_block; ++k) cube(bi * k_block + i, bj * k_block + j, bk * k_block + k);
      }
    }
  }
  return half;
}

} // namespace tutu::rig
