#include "rig/import/gltf/gltf.h"

#include "rig/import/gltf/animations.h"
#include "rig/import/gltf/meshes.h"

namespace tutu::rig::import_detail {

FileScene read_gltf(const std::filesystem::path& file) {
  const GltfDocument document(file);
  FileScene scene;
  scene.file = document.file();
  scene.format = document.format();
  scene.metres_per_unit = 1.0;
  scene.up_axis = 'Y';
  if (document.faces_back()) scene.notes.emplace_back("a character of VRM 0.x, which faces -Z");

  GltfMemory memory(document.file());
  GltfAccessors accessors(document, memory);
  GltfRotations rotations(scene.file);
  const GltfNodes nodes = read_nodes(document, rotations, scene);
  GltfSkins skins(accessors, nodes);
  GltfMeshes meshes(accessors, skins, scene);
  const std::vector<GltfValue> from = document.root().items("nodes");
  for (const std::size_t node : nodes.drawn) meshes.draw(from[node], nodes.node_of[node]);
  read_animations(accessors, nodes, rotations, scene);
  rotations.note(scene);
  return scene;
}

} // namespace tutu::rig::import_detail
