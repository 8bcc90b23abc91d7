// One capsule for all capsules: the vertex shader stretches it.
#pragma once

#include "rig/mesh.h"

#include <vector>

namespace tutu::app {

/// The unit capsule's mesh: points of the unit sphere about the +Y axis and the end (0 = a, 1 = b) each belongs to.
struct CapsuleMesh {
  std::vector<Eigen::Vector4f> vertices;
  std::vector<rig::Triangle> triangles; ///< counter-clockwise from outside
};
CapsuleMesh capsule_mesh(int segments, int rings);

} // namespace tutu::app
