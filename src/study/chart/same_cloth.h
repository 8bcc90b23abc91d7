// One garment in two resolutions: positions of the one at the particles of the other, and how far two shapes are apart.
#pragma once

#include "cloth/garment/garment.h"

#include <span>
#include <vector>

namespace tutu::app {

/// Where the particles of `to` are on the cloth of `from`, whose particles are at `positions`: bilinear in rows and
/// columns. Both are the same garment, of rows and columns, or of the same particles. Throws std::invalid_argument
/// otherwise.
std::vector<Vec3> positions_on(const cloth::Garment& from, std::span<const Vec3> positions, const cloth::Garment& to);

/// Between two surfaces: from the particles of each to the triangles of the other. m.
struct SurfaceDistance {
  double sum_of_squares = 0.0; ///< m2, of both directions
  double hausdorff = 0.0;
  std::int64_t samples = 0;

  double rms() const;
  void add(const SurfaceDistance& other);
};
SurfaceDistance surface_distance(const cloth::Garment& a, std::span<const Vec3> positions_a, const cloth::Garment& b,
                                 std::span<const Vec3> positions_b);

} // namespace tutu::app
