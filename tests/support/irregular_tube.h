// A tube of irregular triangles about the limbs of swinging_limbs.h, held by its upper edge.
#pragma once

#include "cloth/garment/garment.h"
#include "src/study/bench/mesh_sheet.h"

#include <cmath>
#include <numbers>

namespace tutu::test {

/// About `cells` triangles around; radii and length are those of a skirt.
inline cloth::Garment irregular_tube(int cells) {
  constexpr double k_top = 1.3, k_length = 0.5;
  cloth::GarmentDescription description;
  description.file = "tube";
  description.shape = app::mesh_tube(cells, 0.5, 0.25, [](double u, double v) {
    const double angle = 2.0 * std::numbers::pi * u, radius = std::lerp(0.15, 0.3, v);
    return Vec3(radius * std::sin(angle), k_top - v * k_length, radius * std::cos(angle));
  });
  cloth::Attachment upper{"stage"};
  upper.above = k_top;
  description.attachments = {upper};
  return cloth::build_garment(description);
}

} // namespace tutu::test
