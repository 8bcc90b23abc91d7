// A sheet of nearly equilateral triangles: what an imported, remeshed garment is like.
#pragma once

#include "cloth/garment/garment.h"

#include <cmath>
#include <random>

namespace tutu::app {

/// A rectangle from `corner` along `across` and `down` (whole edges), about `cells` triangles' sides wide. Inner
/// corners are moved by up to `jitter` of a side, seeded. Rows of particles run along `across`.
inline cloth::MeshShape mesh_sheet(int cells, const Vec3& corner, const Vec3& across, const Vec3& down,
                                   double jitter = 0.0) {
  std::mt19937 random(1);
  const auto shift = [&] { // not std::uniform_real_distribution, whose numbers are each library's own
    const auto low = static_cast<double>(random()), high = static_cast<double>(random());
    return (low + high * 0x1p32) * 0x1p-64 * (2.0 * jitter) - jitter;
  };
  const double side = 1.0 / cells; // of the width
  const int rows = std::max(1, static_cast<int>(std::lround(down.norm() / (across.norm() * side * std::sqrt(0.75)))));
  cloth::MeshShape mesh;
  std::vector<std::vector<std::uint32_t>> lines(rows + 1);
  std::vector<double> at; // fraction of the width
  for (int row = 0; row <= rows; ++row) {
    const int count = cells + 1 + row % 2; // odd rows are half a side off, with a half one at each end
    for (int k = 0; k < count; ++k) {
      double u = row % 2 == 0 ? k * side : std::clamp((k - 0.5) * side, 0.0, 1.0);
      double v = static_cast<double>(row) / rows;
      if (row > 0 && row < rows && k > 0 && k + 1 < count) {
        u += shift() * side;
        v += shift() / rows;
      }
      lines[row].push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corner + u * across + v * down);
      at.push_back(u);
    }
  }
  for (int row = 0; row < rows; ++row) {
    const auto &upper = lines[row], &lower = lines[row + 1];
    for (std::size_t i = 0, j = 0; i + 1 < upper.size() || j + 1 < lower.size();) {
      const bool above = j + 1 >= lower.size() || (i + 1 < upper.size() && at[upper[i + 1]] <= at[lower[j + 1]]);
      if (above) {
        mesh.triangles.push_back({upper[i], lower[j], upper[i + 1]});
        ++i;
      } else {
        mesh.triangles.push_back({upper[i], lower[j], lower[j + 1]});
        ++j;
      }
    }
  }
  return mesh;
}

/// mesh_sheet() rolled up: `place(u, v)` says where the point is that is the share u in [0, 1] of the way round and v
/// of the way down; a triangle's side is to be about 1 / `cells` of the way round, of which the way down is `length`.
template <class Place> cloth::MeshShape mesh_tube(int cells, double length, double jitter, const Place& place) {
  cloth::MeshShape mesh = mesh_sheet(cells, Vec3::Zero(), Vec3::UnitX(), length * Vec3::UnitY(), jitter);
  std::vector<std::uint32_t> at; // of each corner: where a row ends is where it began
  std::vector<Vec3> rolled;
  std::uint32_t first = 0;
  for (const Vec3& p : mesh.positions) {
    if (p.x() == 0.0) first = static_cast<std::uint32_t>(rolled.size());
    const bool is_end = p.x() == 1.0;
    at.push_back(is_end ? first : static_cast<std::uint32_t>(rolled.size()));
    if (!is_end) rolled.push_back(place(p.x(), p.y() / length));
  }
  mesh.positions = std::move(rolled);
  for (auto& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = at[corner];
  return mesh;
}

} // namespace tutu::app
