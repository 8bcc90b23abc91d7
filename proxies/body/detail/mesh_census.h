// What kind of solid a mesh is, and what is refused.
#pragma once

#include "proxies/body/body_mesh.h"
#include "proxies/body/detail/mesh_topology.h"

#include <functional>

namespace tutu::proxies {

/// Throws std::invalid_argument where indices or positions cannot be used at all.
void require_usable_mesh(std::span<const Vec3f> positions, std::span<const rig::Triangle> triangles);

struct MeshFindings {
  MeshCensus census;
  std::vector<bool> inner; ///< shell: wholly inside the others
};

/// `winding`: the winding number of the whole mesh at a point, to some hundredths. Throws std::invalid_argument on a
/// mesh without sides (see BodyMesh).
MeshFindings take_census(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles,
                         const MeshTopology& topology, const std::function<double(const Vec3&)>& winding);

} // namespace tutu::proxies
