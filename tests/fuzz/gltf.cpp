// Files of glTF, in both containers; their content tells which it is. The reader is called in this process, with no box
// around it.
#include "rig/import/gltf/gltf.h"
#include "tests/fuzz/target.h"

#include <cmath>

namespace tutu::fuzz {
namespace {

using namespace rig::import_detail;

bool is_below(int index, std::size_t size) { return index >= 0 && static_cast<std::size_t>(index) < size; }

void require_mesh(const FileMesh& mesh) {
  for (const rig::Triangle& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) require(v < mesh.positions.size(), "triangles are of vertices there are");
  for (const Vec3f& position : mesh.positions) require(position.allFinite(), "positions are finite");
  for (const Vec3f& normal : mesh.normals) require(normal.allFinite(), "normals are finite");
  require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(), "a normal a position, or none");
  require(mesh.first.empty() == mesh.influences.empty(), "influences come with where they begin");
  if (mesh.first.empty()) return;
  require(mesh.first.size() == mesh.positions.size() + 1 && mesh.first.front() == 0 &&
              mesh.first.back() == static_cast<int>(mesh.influences.size()),
          "influences are of all vertices");
  for (const Influence& influence : mesh.influences)
    require(influence.weight > 0.0 && std::isfinite(influence.weight), "weights are above 0");
}

void require_scene(const FileScene& scene) {
  require(!scene.nodes.empty() && scene.nodes[0].parent == -1, "node 0 is the root");
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    require(n == 0 || is_below(scene.nodes[n].parent, n), "parents come before their children");
    require(scene.nodes[n].local.matrix().allFinite(), "nodes are finite");
  }
  for (const FileMesh& mesh : scene.meshes) require_mesh(mesh);
  for (const FileInstance& instance : scene.instances) {
    require(is_below(instance.mesh, scene.meshes.size()) && is_below(instance.node, scene.nodes.size()),
            "instances are of meshes and nodes there are");
    for (const Binding& binding : instance.skin)
      require(is_below(binding.node, scene.nodes.size()) && binding.inverse_bind.matrix().allFinite(),
              "bindings are of nodes there are");
    if (instance.skin.empty()) continue;
    for (const Influence& influence : scene.meshes[static_cast<std::size_t>(instance.mesh)].influences)
      require(is_below(influence.binding, instance.skin.size()), "influences are of joints there are");
  }
}

void require_animation(const FileAnimation& animation, std::size_t nodes) {
  require(animation.start <= animation.end, "time runs on");
  int last = -1;
  for (const NodeMotion& motion : animation.nodes) {
    require(motion.node > last && is_below(motion.node, nodes), "motions are of rising nodes");
    last = motion.node;
    for (const rig::VectorCurve* curve : {&motion.translation, &motion.scale}) {
      check(*curve, "model", "curve");
      if (!curve->empty()) require(value_at(*curve, 0.5 * animation.end).allFinite(), "curves are finite");
    }
    check(motion.rotation, "model", "curve");
    if (!motion.rotation.empty())
      require(std::abs(value_at(motion.rotation, 0.5 * animation.end).norm() - 1.0) < 1e-6, "rotations are unit");
  }
}

} // namespace

void fuzz_gltf(std::string_view input) {
  const FileScene scene = read_gltf(write_input(input, "model.glb"));
  require_scene(scene);
  for (const FileAnimation& animation : scene.animations) require_animation(animation, scene.nodes.size());
}

} // namespace tutu::fuzz
