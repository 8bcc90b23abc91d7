// Lines across a garment that crossings are counted on: of woven cloth its threads, of any other lines like them.
#pragma once

#include "cloth/garment/garment.h"

#include <span>
#include <vector>

namespace tutu::app {

/// A point of the cloth: between two particles, or one of them (i == j, share 0).
struct ThreadPoint {
  int i = 0, j = 0;
  double share = 0.0; ///< of j, in [0, 1]
};

/// At least two points in a row; a closed one repeats its first.
using Thread = std::vector<ThreadPoint>;

/// Of a grid or tube its rows and columns. Of other triangles the lines in which planes across x, y and z cut the rest
/// shape, at even distances, each axis as many as lengths of a mean edge go into the shape's extent along it (so a flat
/// sheet in the plane of two axes has lines along both). Whatever the topology, such a line ends nowhere but at the
/// border, or where three triangles or more share an edge; hence, as with a thread, a count along it is not fooled by
/// cloth that slides around a limb.
std::vector<Thread> threads_of(const cloth::Garment& garment);

inline Vec3 place_of(const ThreadPoint& point, std::span<const Vec3> positions) {
  if (point.share == 0.0) return positions[point.i];
  return (1.0 - point.share) * positions[point.i] + point.share * positions[point.j];
}

} // namespace tutu::app
