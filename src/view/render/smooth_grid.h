// A coarse grid of particles drawn as a fine, smooth sheet.
#pragma once

#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::app {

/// Particle (row, column) is number row * columns + column. With `closed` the last column is the first one's neighbour,
/// as in a tube. At least 2 rows and 2 columns, 3 when closed.
struct GridShape {
  int rows = 2, columns = 2;
  bool closed = false;
};

/// Splits each cell `factor` x `factor` times along Catmull-Rom splines, which go through the particles: what is drawn
/// is where the simulation is. Front side: columns x rows, i.e. (along a row) x (to the next row); `flipped` turns it
/// round.
class SmoothGrid {
public:
  /// Throws std::invalid_argument for a shape too small or factor < 1.
  SmoothGrid(const GridShape& shape, int factor, bool flipped = false);

  /// One position a particle. Allocates nothing after the first call.
  void update(std::span<const Vec3f> particles);

  const std::vector<Vec3f>& positions() const { return positions_; }
  const std::vector<Vec3f>& normals() const { return normals_; } ///< unit
  const std::vector<rig::Triangle>& triangles() const { return triangles_; }

private:
  GridShape coarse_, fine_;
  int factor_;
  float side_; ///< +1, or -1 when flipped
  std::vector<rig::Triangle> triangles_;
  std::vector<Vec3f> rows_refined_; ///< coarse rows with fine columns
  std::vector<Vec3f> positions_, normals_;
};

} // namespace tutu::app
