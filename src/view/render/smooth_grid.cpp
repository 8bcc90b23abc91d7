#include "src/view/render/smooth_grid.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace tutu::app {
namespace {

int fine_count(int coarse, int factor, bool closed) { return closed ? coarse * factor : (coarse - 1) * factor + 1; }

std::size_t at(int row, int column, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

/// Uniform Catmull-Rom between p[1] (s = 0) and p[2] (s = 1) [Catmull and Rom 1974].
Vec3f catmull_rom(const std::array<Vec3f, 4>& p, float s) {
  const Vec3f linear = p[2] - p[0], square = 2 * p[0] - 5 * p[1] + 4 * p[2] - p[3];
  const Vec3f cube = 3 * (p[1] - p[2]) + p[3] - p[0];
  return p[1] + 0.5f * s * (linear + s * (square + s * cube));
}

/// Point `fine` of the spline through `count` points that `get(i)` gives. Past an open end the line goes on straight.
template <typename Get> Vec3f spline(int fine, int factor, int count, bool closed, Get get) {
  const auto point = [&](int i) -> Vec3f {
    if (closed) return get((i + count) % count);
    if (i < 0) return 2 * get(0) - get(1);
    if (i >= count) return 2 * get(count - 1) - get(count - 2);
    return get(i);
  };
  const int cell = fine / factor, rest = fine % factor;
  if (rest == 0) return point(cell);
  const float s = static_cast<float>(rest) / static_cast<float>(factor);
  return catmull_rom({point(cell - 1), point(cell), point(cell + 1), point(cell + 2)}, s);
}

} // namespace

SmoothGrid::SmoothGrid(const GridShape& shape, int factor, bool flipped)
    : coarse_(shape), factor_(factor), side_(flipped ? -1.0f : 1.0f) {
  if (shape.rows < 2 || shape.columns < (shape.closed ? 3 : 2) || factor < 1)
    throw std::invalid_argument("a grid to smooth needs 2 x 2 particles, 3 around, and a factor of at least 1");
  fine_ = {.rows = fine_count(shape.rows, factor, false),
           .columns = fine_count(shape.columns, factor, shape.closed),
           .closed = shape.closed};
  const int cells = fine_.closed ? fine_.columns : fine_.columns - 1;
  for (int row = 0; row + 1 < fine_.rows; ++row)
    for (int column = 0; column < cells; ++column) {
      const auto index = [&](int r, int c) {
        return static_cast<std::uint32_t>(at(r, c % fine_.columns, fine_.columns));
      };
      const std::uint32_t a = index(row, column), b = index(row, column + 1);
      const std::uint32_t c = index(row + 1, column), d = index(row + 1, column + 1);
      triangles_.push_back({a, b, c});
      triangles_.push_back({b, d, c});
    }
  if (flipped)
    for (rig::Triangle& t : triangles_) std::swap(t[1], t[2]);
}

void SmoothGrid::update(std::span<const Vec3f> particles) {
  if (particles.size() != at(coarse_.rows, 0, coarse_.columns))
    throw std::invalid_argument("a grid to smooth needs one position a particle");
  rows_refined_.resize(at(coarse_.rows, 0, fine_.columns));
  for (int row = 0; row < coarse_.rows; ++row)
    for (int column = 0; column < fine_.columns; ++column)
      rows_refined_[at(row, column, fine_.columns)] =
          spline(column, factor_, coarse_.columns, coarse_.closed,
                 [&](int i) -> const Vec3f& { return particles[at(row, i, coarse_.columns)]; });
  positions_.resize(at(fine_.rows, 0, fine_.columns));
  for (int row = 0; row < fine_.rows; ++row)
    for (int column = 0; column < fine_.columns; ++column)
      positions_[at(row, column, fine_.columns)] =
          spline(row, factor_, coarse_.rows, false,
                 [&](int i) -> const Vec3f& { return rows_refined_[at(i, column, fine_.columns)]; });

  normals_.resize(positions_.size());
  const auto position = [&](int row, int column) -> const Vec3f& {
    column = fine_.closed ? (column + fine_.columns) % fine_.columns : std::clamp(column, 0, fine_.columns - 1);
    return positions_[at(std::clamp(row, 0, fine_.rows - 1), column, fine_.columns)];
  };
  for (int row = 0; row < fine_.rows; ++row)
    for (int column = 0; column < fine_.columns; ++column) {
      const Vec3f along = position(row, column + 1) - position(row, column - 1);
      const Vec3f onwards = position(row + 1, column) - position(row - 1, column);
      const Vec3f normal = side_ * along.cross(onwards);
      const float length = normal.norm();
      normals_[at(row, column, fine_.columns)] = length > 0 ? Vec3f(normal / length) : Vec3f::UnitY();
    }
}

} // namespace tutu::app
