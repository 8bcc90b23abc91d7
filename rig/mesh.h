// A triangle mesh in the bind pose.
#pragma once

#include "rig/math.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tutu::rig {

using Triangle = std::array<std::uint32_t, 3>; ///< vertex indices, counter-clockwise seen from outside

/// A run of triangles that came from one mesh of the file: "surface", "joint spheres".
struct MeshPart {
  std::string name;
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::array<float, 3> colour = {0.8f, 0.8f, 0.8f}; ///< linear RGB of its material, when the file gives one
};

/// Model space, m, +Y up, facing +Z.
struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals; ///< unit, one a position
  std::vector<Triangle> triangles;
  std::vector<MeshPart> parts; ///< cover all triangles in order

  int vertex_count() const { return static_cast<int>(positions.size()); }
};

/// Area- and angle-independent: sum of face normals weighted by corner angle [Thürmer and Wüthrich 1998], unit length.
/// A vertex without area gets +Y.
std::vector<Vec3f> angle_weighted_normals(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles);

} // namespace tutu::rig
