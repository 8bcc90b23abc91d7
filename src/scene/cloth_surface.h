// The surface that is drawn for a garment: finer and smoother than its particles.
#pragma once

#include "cloth/garment.h"
#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::app {

/// A Catmull-Rom surface through the particles, `k_refinement` cells a cell each way. It passes through every particle, so what is
/// drawn is what was simulated; only the chords between particles are rounded.
class ClothSurface {
public:
  static constexpr int k_refinement = 3;

  explicit ClothSurface(const cloth::Garment& garment);

  /// Positions and normals for these particle positions (the garment's order, world, m).
  void update(std::span<const Vec3> particles);

  std::span<const Vec3f> positions() const { return positions_; }
  std::span<const Vec3f> normals() const { return normals_; }
  std::span<const rig::Triangle> triangles() const { return triangles_; }

private:
  /// A sample along one direction: four particles (rows or columns) and their weights.
  struct Sample {
    int index[4];
    double weight[4];
  };
  static std::vector<Sample> samples(int count, bool closed);

  int columns_;
  std::vector<Sample> row_samples_, column_samples_;
  std::vector<Vec3> along_rows_; ///< [row][fine column]: half-way, refined along the columns only
  std::vector<Vec3f> positions_, normals_;
  std::vector<rig::Triangle> triangles_;
};

} // namespace tutu::app
