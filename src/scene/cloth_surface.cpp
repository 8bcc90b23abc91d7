#include "src/scene/cloth_surface.h"

#include <algorithm>

namespace tutu::app {

std::vector<ClothSurface::Sample> ClothSurface::samples(int count, bool closed) {
  std::vector<Sample> all;
  const int cells = closed ? count : count - 1;
  const int fine = closed ? cells * k_refinement : cells * k_refinement + 1;
  for (int k = 0; k < fine; ++k) {
    const int cell = std::min(k / k_refinement, cells - 1);
    const double t = static_cast<double>(k - cell * k_refinement) / k_refinement;
    // Uniform Catmull-Rom basis [Catmull and Rom 1974], tension 1/2.
    const double weight[4] = {0.5 * t * (-1 + t * (2 - t)), 0.5 * (2 + t * t * (-5 + 3 * t)), 0.5 * t * (1 + t * (4 - 3 * t)),
                              0.5 * t * t * (t - 1)};
    Sample sample{};
    for (int n = 0; n < 4; ++n) {
      const int index = cell - 1 + n;
      sample.index[n] = closed ? (index + count) % count : std::clamp(index, 0, count - 1);
      sample.weight[n] = weight[n];
    }
    if (!closed) { // beyond a border the curve goes straight on: p(-1) = 2 p(0) - p(1)
      const auto extend = [&](int outside, int edge, int inside) {
        sample.weight[edge] += 2.0 * sample.weight[outside];
        sample.weight[inside] -= sample.weight[outside];
        sample.weight[outside] = 0.0;
      };
      if (cell == 0) extend(0, 1, 2);
      if (cell == cells - 1) extend(3, 2, 1);
    }
    all.push_back(sample);
  }
  return all;
}

ClothSurface::ClothSurface(const cloth::Garment& garment)
    : columns_(garment.columns), row_samples_(samples(garment.rows, false)),
      column_samples_(samples(garment.columns, garment.woven_shut)) {
  const int rows = static_cast<int>(row_samples_.size()), columns = static_cast<int>(column_samples_.size());
  along_rows_.resize(static_cast<std::size_t>(garment.rows) * columns);
  positions_.resize(static_cast<std::size_t>(rows) * columns);
  normals_.resize(positions_.size());
  const int cells = garment.woven_shut ? columns : columns - 1;
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column < cells; ++column) {
      const auto at = [&](int r, int c) { return static_cast<std::uint32_t>(r * columns + c % columns); };
      const std::uint32_t a = at(row, column), b = at(row, column + 1), c = at(row + 1, column), d = at(row + 1, column + 1);
      triangles_.push_back({a, c, b});
      triangles_.push_back({b, c, d});
    }
  update(garment.rest_positions);
}

void ClothSurface::update(std::span<const Vec3> particles) {
  const std::size_t fine_columns = column_samples_.size();
  const std::size_t rows = along_rows_.size() / fine_columns;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t k = 0; k < fine_columns; ++k) {
      const Sample& s = column_samples_[k];
      const Vec3* p = particles.data() + row * static_cast<std::size_t>(columns_);
      along_rows_[row * fine_columns + k] =
          s.weight[0] * p[s.index[0]] + s.weight[1] * p[s.index[1]] + s.weight[2] * p[s.index[2]] + s.weight[3] * p[s.index[3]];
    }
  for (std::size_t row = 0; row < row_samples_.size(); ++row) {
    const Sample& s = row_samples_[row];
    for (std::size_t k = 0; k < fine_columns; ++k) {
      const auto line = [&](int n) -> const Vec3& { return along_rows_[static_cast<std::size_t>(s.index[n]) * fine_columns + k]; };
      const Vec3 p = s.weight[0] * line(0) + s.weight[1] * line(1) + s.weight[2] * line(2) + s.weight[3] * line(3);
      positions_[row * fine_columns + k] = p.cast<float>();
    }
  }
  std::fill(normals_.begin(), normals_.end(), Vec3f::Zero());
  for (const rig::Triangle& t : triangles_) { // area-weighted: the cells are nearly alike
    const Vec3f normal = (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]);
    for (const std::uint32_t v : t) normals_[v] += normal;
  }
  for (Vec3f& n : normals_) {
    const float length = n.norm();
    n = length > 0.0f ? Vec3f(n / length) : Vec3f(Vec3f::UnitY());
  }
}

} // namespace tutu::app
