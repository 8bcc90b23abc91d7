// Garments of threads for tests: closed and open, of awkward counts, pinned anywhere.
#pragma once

#include "cloth/garment/garment.h"
#include "cloth/woven/sheet.h"
#include "tests/support/collider_scenes.h"

#include <random>
#include <string>
#include <vector>

namespace tutu::test {

struct WovenCase {
  std::string name;
  cloth::Garment garment;
};

namespace detail {

inline cloth::Garment tube(int rows, int columns, cloth::Fabric fabric, double flatness, std::optional<double> seam) {
  cloth::GarmentDescription description;
  description.file = "tube";
  description.fabric = fabric;
  cloth::TubeShape shape;
  shape.rows = rows;
  shape.columns = columns;
  shape.seam = seam;
  shape.rings = {
      {1.3, 0.15, 0.15 * flatness, 0, 0}, {1.1, 0.2, 0.2 * flatness, 0, 0.02}, {0.8, 0.4, 0.4 * flatness, 0, 0}};
  description.shape = shape;
  return cloth::build_garment(description);
}

inline cloth::Garment grid(int rows, int columns, cloth::Fabric fabric) {
  cloth::GarmentDescription description;
  description.file = "grid";
  description.fabric = fabric;
  description.shape = cloth::GridShape{rows, columns, {-0.25, 1.2, 0.1}, {0.5, 0, 0}, {0, -0.3, 0.25}};
  return cloth::build_garment(description);
}

inline void pin(cloth::Garment& garment, std::mt19937_64& random, int count) {
  std::vector<int> all(garment.rest_positions.size());
  std::iota(all.begin(), all.end(), 0);
  std::shuffle(all.begin(), all.end(), random);
  for (int k = 0; k < count; ++k) garment.pins.push_back({all[k], 0});
  std::sort(garment.pins.begin(), garment.pins.end(),
            [](const cloth::Pin& a, const cloth::Pin& b) { return a.particle < b.particle; });
}

/// Pins more of the first row until the sheet is not laid turned: the twin knows rows and columns as they are.
inline void hold_upright(cloth::Garment& garment) {
  for (int column = 0; column < garment.columns && cloth::Weave(garment).turned; ++column)
    if (!cloth::pinned_flags(garment)[column]) garment.pins.push_back({column, 0});
}

} // namespace detail

/// Every shape of the layout: lanes from 1 to 16, blocks from 2 up, columns that fill the lanes and do not.
inline std::vector<WovenCase> woven_cases() {
  std::mt19937_64 random(11);
  cloth::Fabric plain, limp, stiff;
  limp.bend = limp.shear = 0.0;
  stiff.bend = 1e-3;
  stiff.stretch = 4000.0;
  cloth::Fabric sleek = plain;
  sleek.bend = 0.0;
  const auto no_seam = std::nullopt;
  std::vector<WovenCase> cases = {
      {"ring, 16 lanes, 3 blocks", detail::tube(14, 48, plain, 1.0, no_seam)},
      {"ring, 16 lanes, 2 blocks, without bend", detail::tube(9, 32, sleek, 1.0, no_seam)},
      {"ring, 16 lanes, without bend and shear", detail::tube(17, 64, limp, 1.0, no_seam)},
      {"ring, 15 lanes", detail::tube(11, 45, plain, 1.0, no_seam)},
      {"ring, 15 lanes, ellipse, stiff", detail::tube(20, 60, stiff, 0.6, no_seam)},
      {"ring, 10 lanes, ellipse", detail::tube(8, 40, plain, 0.7, no_seam)},
      {"ring, prime", detail::tube(9, 31, plain, 0.8, no_seam)},
      {"ring, smallest", detail::tube(2, 4, plain, 1.0, no_seam)},
      {"slit tube", detail::tube(13, 41, plain, 0.8, 0.5)},
      {"grid, fitting", detail::grid(16, 48, plain)},
      {"grid, prime", detail::grid(9, 31, stiff)},
      {"grid, long", detail::grid(40, 20, plain)},
      {"grid, wide, without bend", detail::grid(3, 100, sleek)},
      {"grid, smallest but two", detail::grid(4, 4, plain)},
      {"grid, two columns", detail::grid(5, 2, plain)},
      {"grid, smallest", detail::grid(2, 2, limp)},
  };
  const std::size_t shapes = cases.size();
  for (std::size_t k = 0; k < shapes; ++k) { // each once more, pinned
    WovenCase pinned = cases[k];
    pinned.name += ", pinned";
    detail::pin(pinned.garment, random, std::max(1, pinned.garment.particle_count() / 12));
    detail::hold_upright(pinned.garment);
    cases.push_back(pinned);
  }
  cases.push_back({"grid, by two corners", detail::grid(24, 20, plain)});
  cases.back().garment.pins = {{0, 0}, {19, 0}};
  cases.push_back({"ring, by three particles", detail::tube(15, 48, plain, 0.9, no_seam)});
  cases.back().garment.pins = {{0, 0}, {17, 0}, {31, 0}};
  return cases;
}

/// Rings whose columns most numbers of lanes do not divide, of each kind of fabric: free, pinned by chance, and held by
/// three particles, which tethers them.
inline std::vector<WovenCase> uneven_rings() {
  std::mt19937_64 random(12);
  const cloth::Fabric plain;
  cloth::Fabric sleek = plain, loose = plain, limp = plain;
  sleek.bend = loose.shear = limp.bend = limp.shear = 0.0;
  std::vector<WovenCase> cases;
  for (const int columns : {7, 15, 17, 31, 33, 47, 61, 127}) {
    int rows = 5;
    for (const auto& [fabric, kind] : {std::pair(plain, ""), std::pair(sleek, ", without bend"),
                                       std::pair(loose, ", without shear"), std::pair(limp, ", without either")}) {
      const std::string name = "ring of " + std::to_string(columns) + kind;
      cases.push_back({name, detail::tube(rows++, columns, fabric, 0.8, std::nullopt)});
      cases.push_back({name + ", pinned", cases.back().garment});
      detail::pin(cases.back().garment, random, columns / 3);
      cases.push_back({name + ", tethered", cases[cases.size() - 2].garment});
      cases.back().garment.pins = {{0, 0}, {columns / 3, 0}, {columns - 2, 0}};
    }
  }
  return cases;
}

/// Of a pinned row 0, as a skirt hangs.
inline void pin_first_row(cloth::Garment& garment) {
  garment.pins.clear();
  for (int column = 0; column < garment.columns; ++column) garment.pins.push_back({column, 0});
}

} // namespace tutu::test
