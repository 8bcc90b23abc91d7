// Private to the glTF reader: KHR_draco_mesh_compression.
#pragma once

#include "rig/import/gltf/accessors.h"
#include "rig/mesh.h"

#include <memory>
#include <string_view>
#include <vector>

namespace draco {
class Mesh;
}

namespace tutu::rig::import_detail {

/// The geometry of one primitive, decompressed by libdraco.
class DracoGeometry {
public:
  /// `extension` is the object at the primitive. Throws InputError naming the extension on a stream that cannot be
  /// decoded or that claims more than its bytes can explain.
  DracoGeometry(const GltfValue& extension, GltfAccessors& accessors);
  ~DracoGeometry();
  DracoGeometry(const DracoGeometry&) = delete;
  DracoGeometry& operator=(const DracoGeometry&) = delete;

  std::vector<Triangle> triangles() const;
  bool has(std::string_view attribute) const { return extension_.at("attributes").find(attribute).has_value(); }
  /// One element a vertex of an attribute that it has; `reference` names the accessor, which says what the numbers
  /// mean (componentType, normalized). They live as long as this does.
  GltfElements elements(std::string_view attribute, const GltfValue& reference, std::string_view type);

private:
  GltfValue extension_;
  GltfAccessors& accessors_;
  std::unique_ptr<draco::Mesh> mesh_;
  std::vector<std::vector<std::uint32_t>> wholes_;
  std::vector<std::vector<float>> reals_;
};

} // namespace tutu::rig::import_detail
