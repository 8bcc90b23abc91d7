// Private to the glTF reader: animations.
#pragma once

#include "rig/import/detail/file_scene.h"
#include "rig/import/gltf/accessors.h"
#include "rig/import/gltf/nodes.h"

namespace tutu::rig::import_detail {

/// Fills FileScene::animations. Throws InputError on two channels of one node and path, on samplers whose keys and
/// values are not as many, on times that fall.
void read_animations(GltfAccessors& accessors, const GltfNodes& nodes, GltfRotations& rotations, FileScene& scene);

} // namespace tutu::rig::import_detail
