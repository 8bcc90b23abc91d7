// Private to the glTF reader: the tree of nodes, and skins.
#pragma once

#include "rig/import/detail/file_scene.h"
#include "rig/import/gltf/accessors.h"
#include "rig/import/gltf/rotations.h"

#include <optional>
#include <vector>

namespace tutu::rig::import_detail {

struct GltfNodes {
  std::vector<int> node_of;       ///< [glTF's index]: of FileScene::nodes
  std::vector<std::size_t> drawn; ///< glTF's indices of what is visible in the default scene, parent before child
};

/// Fills FileScene::nodes. Throws InputError on circles, nodes with two parents, transforms that are none.
GltfNodes read_nodes(const GltfDocument& document, GltfRotations& rotations, FileScene& scene);

/// Each skin is read when it is first asked for.
class GltfSkins {
public:
  GltfSkins(GltfAccessors& accessors, const GltfNodes& nodes)
      : accessors_(accessors), nodes_(nodes), skins_(accessors.document().count("skins")) {}

  /// Of the skin that `reference` names by its index. Throws InputError on joints and inverse binds that are not there.
  const std::vector<Binding>& skin(const GltfValue& reference);

private:
  GltfAccessors& accessors_;
  const GltfNodes& nodes_;
  std::vector<std::optional<std::vector<Binding>>> skins_;
};

} // namespace tutu::rig::import_detail
