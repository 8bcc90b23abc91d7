// Private to the glTF reader: one primitive of a mesh.
#pragma once

#include "rig/import/detail/file_scene.h"
#include "rig/import/gltf/accessors.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tutu::rig::import_detail {

/// Geometry, influences (whose bindings are indices of joints of whatever skin draws it) and what was left aside.
struct GltfPrimitive {
  FileMesh mesh; ///< without name and colour
  std::string place;
  std::uint32_t highest_joint = 0; ///< with a weight above 0
  std::size_t highest_joint_vertex = 0;
  std::size_t morphed = 0;        ///< targets whose weight is not 0
  std::vector<std::string> notes; ///< without the place: "no positions, which is not drawn"

  bool has_influences() const { return !mesh.influences.empty(); }
};

/// `weights`: of morph targets; those that are missing are 0. Throws InputError on attributes that do not fit together,
/// indices out of range, weights that are negative, numbers that are none.
GltfPrimitive read_primitive(const GltfValue& primitive, const std::vector<double>& weights, GltfAccessors& accessors);

/// Leaves out vertices that no triangle uses.
void keep_used_vertices(FileMesh& mesh);

} // namespace tutu::rig::import_detail
