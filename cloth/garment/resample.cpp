#include "cloth/garment/garment.h"
#include "rig/error.h"

#include <cmath>
#include <fmt/format.h>

namespace tutu::cloth {
namespace {

int times(int cells, double factor) {
  return static_cast<int>(std::lround(std::min(factor * cells, 1e6))); // what is too many is refused when it is built
}

/// Row or column `index` of a grid of `before` particles a side, in one of `after`; negative ones count from the end.
int moved(int index, int before, int after) {
  if (index < 0) return -1 - moved(-1 - index, before, after);
  return before > 1 ? times(index, static_cast<double>(after - 1) / (before - 1)) : index;
}

struct Sides {
  int rows = 0, columns = 0;
};
Sides sides_of(const GridShape& grid) { return {grid.rows, grid.columns}; }
Sides sides_of(const TubeShape& tube) { return {tube.rows, tube.columns}; }
template <class Shape> Sides sides_of(const Shape&) { return {}; }

void resample(GridShape& grid, double factor, const std::string&) {
  grid.rows = 1 + times(grid.rows - 1, factor);
  grid.columns = 1 + times(grid.columns - 1, factor);
}
void resample(TubeShape& tube, double factor, const std::string&) {
  tube.rows = 1 + times(tube.rows - 1, factor);
  tube.columns = tube.seam ? 1 + times(tube.columns - 1, factor) : times(tube.columns, factor);
}
void resample(DiscShape& disc, double factor, const std::string&) { disc.rings = times(disc.rings, factor); }
void resample(MeshShape&, double factor, const std::string& file) {
  throw InputError(file, "/shape/mesh", fmt::format("a resolution of {:g}", factor),
                   "1: the particles of a mesh are its own");
}

} // namespace

GarmentDescription resampled(GarmentDescription description, double factor) {
  if (factor == 1.0) return description;
  const auto sides = [&] { return std::visit([](const auto& shape) { return sides_of(shape); }, description.shape); };
  const Sides before = sides();
  std::visit([&](auto& shape) { resample(shape, factor, description.file); }, description.shape);
  const Sides after = sides();
  for (Attachment& attachment : description.attachments) {
    if (attachment.by_place()) continue;
    for (int* row : {&attachment.first_row, &attachment.last_row}) *row = moved(*row, before.rows, after.rows);
    for (int* column : {&attachment.first_column, &attachment.last_column})
      *column = moved(*column, before.columns, after.columns);
  }
  return description;
}

} // namespace tutu::cloth
