#include "rig/mesh.h"

#include <cmath>

namespace tutu::rig {

std::vector<Vec3f> angle_weighted_normals(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> sums(positions.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 p[3] = {positions[t[0]].cast<double>(), positions[t[1]].cast<double>(), positions[t[2]].cast<double>()};
    const Vec3 area = (p[1] - p[0]).cross(p[2] - p[0]);
    const double length = area.norm();
    if (!(length > 0.0)) continue;
    for (int c = 0; c < 3; ++c) {
      const Vec3 a = p[(c + 1) % 3] - p[c], b = p[(c + 2) % 3] - p[c];
      sums[t[c]] += std::atan2(length, a.dot(b)) / length * area; // |a x b| is the same at each corner
    }
  }
  std::vector<Vec3f> normals(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const double length = sums[v].norm();
    normals[v] = length > 0.0 ? Vec3f((sums[v] / length).cast<float>()) : Vec3f::UnitY();
  }
  return normals;
}

} // namespace tutu::rig
