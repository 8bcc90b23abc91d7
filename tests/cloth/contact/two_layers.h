// Cloth on cloth for tests and benches: two sheets that are one garment, and a sheet folded in two.
#pragma once

#include "cloth/garment/garment.h"

#include <cmath>
#include <numbers>

namespace tutu::test {

/// Two level sheets of n x n particles and `side` m, of one garment; the second `above` m over the first and moved by
/// `shift` of a cell along x and z. Columns 0..n-1 are the first's. The first lies at y = 0.
inline cloth::Garment two_sheets(int n, double side, double above, double shift, cloth::Fabric fabric) {
  fabric.bend = 0.0; // it would reach from sheet to sheet
  cloth::GarmentDescription description;
  description.file = "two sheets";
  const double cell = side / (n - 1);
  description.shape = cloth::GridShape{n, 2 * n, Vec3::Zero(), {cell * (2 * n - 1), 0, 0}, {0, 0, side}};
  description.fabric = fabric;
  cloth::Garment garment = cloth::build_garment(description);
  const auto is_second = [n](std::uint32_t particle) { return static_cast<int>(particle) % (2 * n) >= n; };
  std::erase_if(garment.springs, [&](const cloth::Spring& s) { return is_second(s.i) != is_second(s.j); });
  garment.structural_count = 0;
  for (const cloth::Spring& spring : garment.springs)
    garment.structural_count += spring.kind == cloth::SpringKind::structural ? 1 : 0;
  std::erase_if(garment.triangles, [&](const auto& t) {
    return is_second(t[0]) != is_second(t[1]) || is_second(t[0]) != is_second(t[2]);
  });
  for (int i = 0; i < garment.particle_count(); ++i)
    if (is_second(i)) garment.rest_positions[i] += Vec3(shift * cell - cell * n, above, shift * cell);
  return garment;
}

/// A level sheet of n x n particles and `side` m at y = 0; `start` has it folded along its middle row, with the free
/// half at `degrees` (180: flat on the other).
inline cloth::Garment folded_sheet(int n, double side, double degrees, cloth::Fabric fabric, std::vector<Vec3>& start) {
  cloth::GarmentDescription description;
  description.file = "folded sheet";
  description.shape = cloth::GridShape{n, n, Vec3::Zero(), {side, 0, 0}, {0, 0, side}};
  description.fabric = fabric;
  cloth::Garment garment = cloth::build_garment(description);
  start = garment.rest_positions;
  const double angle = degrees * std::numbers::pi / 180.0, cell = side / (n - 1), middle = (n / 2) * cell;
  for (Vec3& p : start)
    if (const double beyond = p.z() - middle; beyond > 0.0)
      p = Vec3(p.x(), beyond * std::sin(angle), middle + beyond * std::cos(angle));
  return garment;
}

} // namespace tutu::test
