#include "rig/import/gltf/gltf.h"

#include "rig/import/detail/parts.h"
#include "rig/import/gltf/animations.h"
#include "rig/import/gltf/meshes.h"

#include <set>

namespace tutu::rig::import_detail {
namespace {

/// Textures are never opened.
void note_outside_textures(const GltfDocument& document, FileScene& scene) {
  const Reach reach(document.path());
  std::set<std::string> outside;
  for (const GltfValue& image : document.root().items("images"))
    if (const std::string uri = image.text_or("uri", ""); !uri.empty() && !uri.starts_with("data:"))
      if (const std::string name = decode_percent(uri); !reach.holds_name(name)) outside.insert(name);
  if (!outside.empty())
    scene.notes.push_back(count_of(outside.size(), "texture") +
                          " outside of the file's folder not opened: " + list_of({outside.begin(), outside.end()}));
}

} // namespace

FileScene read_gltf(const std::filesystem::path& file) {
  const GltfDocument document(file);
  FileScene scene;
  scene.file = document.file();
  scene.format = document.format();
  scene.metres_per_unit = 1.0;
  scene.up_axis = 'Y';
  if (document.faces_back()) scene.notes.emplace_back("a character of VRM 0.x, which faces -Z");

  if (document.has_foreign_bytes()) scene.notes.emplace_back("names that are not UTF-8: _ stands for what is not");
  GltfMemory memory(document.file());
  GltfAccessors accessors(document, memory);
  GltfRotations rotations(scene.file);
  const GltfNodes nodes = read_nodes(document, rotations, scene);
  GltfSkins skins(accessors, nodes);
  GltfMeshes meshes(accessors, skins, scene);
  const std::vector<GltfValue> from = document.root().items("nodes");
  for (const std::size_t node : nodes.drawn) meshes.draw(from[node], nodes.node_of[node]);
  meshes.note();
  read_animations(accessors, nodes, rotations, scene);
  rotations.note(scene);
  note_outside_textures(document, scene);
  return scene;
}

} // namespace tutu::rig::import_detail
