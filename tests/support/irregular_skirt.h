// A skirt for the dancer as somebody else's program would make it: a mesh of irregular triangles.
#pragma once

#include "rig/io/file_io.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <numbers>
#include <random>
#include <string>

namespace tutu::test {

/// Writes `name`.obj, its garment `name`.garment.json and a scene of the dance in it; returns the scene. About the
/// dancer's waist, hips and legs as her own skirt: rows x columns corners, moved by up to a quarter of a cell within
/// the surface, each cell cut along either diagonal. `clearance`: m, of the fabric.
inline std::string irregular_skirt(const std::filesystem::path& folder, const std::string& name, int rows, int columns,
                                   double clearance) {
  struct Ring {
    double height, half_width, half_depth, forward; // m, at rest
  };
  constexpr std::array<Ring, 4> k_rings = {
      {{1.06, 0.129, 0.089, 0.005}, {0.98, 0.155, 0.107, 0.0}, {0.88, 0.208, 0.154, -0.01}, {0.55, 0.44, 0.40, -0.01}}};
  std::array<double, 4> down = {}; // m along the wall, of each ring
  for (std::size_t k = 1; k < 4; ++k) {
    const Ring &upper = k_rings[k - 1], &lower = k_rings[k];
    const double out = 0.5 * (lower.half_width + lower.half_depth - upper.half_width - upper.half_depth);
    down[k] = down[k - 1] + std::hypot(upper.height - lower.height, out);
  }
  std::mt19937 random(1);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-32; }; // the same with every library
  std::string mesh;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double sideways = 0.5 * unit() - 0.25, along = 0.5 * unit() - 0.25;
      const bool is_inner = row > 0 && row + 1 < rows;
      const double at = down[3] * (row + (is_inner ? along : 0.0)) / (rows - 1);
      const std::size_t k = at < down[1] ? 0 : at < down[2] ? 1 : 2;
      const double t = (at - down[k]) / (down[k + 1] - down[k]);
      const double angle = 2.0 * std::numbers::pi * (column + (row > 0 ? sideways : 0.0)) / columns;
      const Ring &a = k_rings[k], &b = k_rings[k + 1];
      mesh +=
          fmt::format("v {:.6f} {:.6f} {:.6f}\n", std::lerp(a.half_width, b.half_width, t) * std::sin(angle),
                      std::lerp(a.height, b.height, t),
                      std::lerp(a.forward, b.forward, t) + std::lerp(a.half_depth, b.half_depth, t) * std::cos(angle));
    }
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int a = row * columns + column + 1, b = row * columns + (column + 1) % columns + 1;
      const int c = a + columns, d = b + columns;
      mesh += unit() < 0.5 ? fmt::format("f {} {} {}\nf {} {} {}\n", a, c, b, b, c, d)
                           : fmt::format("f {} {} {}\nf {} {} {}\n", a, c, d, a, d, b);
    }
  write_file(folder / (name + ".obj"), mesh);
  write_file(folder / (name + ".garment.json"),
             fmt::format(R"({{"name": "skirt", "shape": {{"mesh": {{"file": "{}.obj"}}}},
  "fabric": {{"density": 0.2, "stretch": 1000, "shear": 8, "bend": 1e-5, "drag": 0.8, "thickness": 0.002, "clearance": {}}},
  "attachments": [{{"joint": "Spine", "above": 1.0599}}]}})",
                         name, clearance));
  const std::string assets = TUTU_SOURCE_DIR "/assets/";
  write_file(folder / (name + ".json"), fmt::format(R"({{"character": "{0}characters/dancer.dae",
  "motion": "{0}poses/dance.json", "proxies": "{0}proxies/dancer.json", "garments": ["{1}.garment.json"],
  "solver": {{"name": "xpbd", "substeps": 12, "frames_per_second": 60}}}})",
                                                    assets, name));
  return (folder / (name + ".json")).string();
}

} // namespace tutu::test
