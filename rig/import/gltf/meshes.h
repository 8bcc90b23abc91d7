// Private to the glTF reader: what nodes draw.
#pragma once

#include "rig/import/detail/file_scene.h"
#include "rig/import/gltf/nodes.h"
#include "rig/import/gltf/primitive.h"

#include <map>
#include <utility>
#include <vector>

namespace tutu::rig::import_detail {

/// Fills FileScene::meshes and instances. A mesh is made once for each set of default weights it is drawn with.
class GltfMeshes {
public:
  GltfMeshes(GltfAccessors& accessors, GltfSkins& skins, FileScene& scene);

  /// What this node of the file draws, with its skin; `index` is its place among FileScene::nodes.
  void draw(const GltfValue& node, int index);
  /// What was left out of primitives: one note a kind.
  void note() const;

private:
  struct Part {
    int mesh = -1; ///< of FileScene::meshes
    bool has_influences = false;
    std::uint32_t highest_joint = 0;
    std::size_t highest_joint_vertex = 0;
    std::string place;
  };
  const std::vector<Part>& parts_of(const GltfValue& mesh, std::size_t index, const std::vector<double>& weights);
  Part part_of(const GltfValue& primitive, const std::string& name, const std::vector<double>& weights);
  std::array<float, 3> colour_of(const GltfValue& primitive) const;

  GltfAccessors& accessors_;
  GltfSkins& skins_;
  FileScene& scene_;
  std::vector<int> users_; ///< [accessor]: primitives whose positions it holds
  std::map<std::pair<std::size_t, std::vector<double>>, std::vector<Part>> parts_;
  struct Left {
    std::size_t count = 0;
    std::string first_place;
  };
  std::map<std::string, Left> left_out_; ///< by what is said of it
};

} // namespace tutu::rig::import_detail
