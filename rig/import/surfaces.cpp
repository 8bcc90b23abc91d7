// What the file's meshes hang on: weights normalised, vertices without any hung on the mesh's main joint.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <algorithm>

namespace tutu::rig::import_detail {
namespace {

bool has_skin(const FileScene& scene, const FileInstance& instance) {
  return !instance.skin.empty() && !scene.meshes[instance.mesh].influences.empty();
}

/// Fills first, influences and dominant; returns how many vertices had no weight and went to the dominant binding.
std::size_t set_influences(Surface& surface) {
  const FileMesh& mesh = *surface.mesh;
  std::vector<double> total(surface.bindings.size(), 0.0);
  for (const Influence& influence : mesh.influences) total[influence.binding] += influence.weight;
  surface.dominant = static_cast<int>(std::max_element(total.begin(), total.end()) - total.begin());
  std::size_t bare = 0;
  surface.first = {0};
  surface.first.reserve(mesh.positions.size() + 1);
  surface.influences.reserve(mesh.influences.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const int begin = mesh.first.empty() ? 0 : mesh.first[v], end = mesh.first.empty() ? 0 : mesh.first[v + 1];
    double sum = 0.0;
    for (int i = begin; i < end; ++i) sum += mesh.influences[i].weight;
    for (int i = begin; i < end; ++i)
      surface.influences.push_back({mesh.influences[i].binding, mesh.influences[i].weight / sum});
    if (begin == end) {
      surface.influences.push_back({surface.dominant, 1.0});
      ++bare;
    }
    surface.first.push_back(static_cast<int>(surface.influences.size()));
  }
  return bare;
}

} // namespace

std::vector<Surface> skinned_surfaces(const FileScene& scene, const std::vector<Node>& nodes, ImportReport& report) {
  if (scene.meshes.empty()) throw InputError(scene.file, "", "no mesh", "a mesh with a skin");
  std::vector<Surface> surfaces;
  report.file_meshes = static_cast<int>(scene.meshes.size());
  for (const FileInstance& instance : scene.instances) {
    if (!has_skin(scene, instance)) continue;
    const FileMesh& mesh = scene.meshes[instance.mesh];
    Surface& surface = surfaces.emplace_back();
    surface.mesh = &mesh;
    surface.holder = instance.node;
    surface.bindings = instance.skin;
    surface.bind_shape = instance.bind_shape;
    if (const std::size_t bare = set_influences(surface); bare > 0)
      report.notes.push_back("mesh " + mesh.name + ": " + count_of(bare, "vertex") + " without weights bound to " +
                             nodes[surface.bindings[surface.dominant].node].name);
  }
  if (surfaces.empty())
    throw InputError(scene.file, "", count_of(scene.meshes.size(), "mesh") + " without a skin",
                     "a mesh bound to joints");
  return surfaces;
}

std::vector<Surface> rigid_surfaces(const FileScene& scene, const std::vector<Node>& nodes, ImportReport& report) {
  std::vector<Surface> surfaces;
  std::vector<std::string> hung, left_out;
  std::vector<bool> drawn(scene.meshes.size(), false);
  for (const FileInstance& instance : scene.instances) {
    drawn[instance.mesh] = true;
    const FileMesh& mesh = scene.meshes[instance.mesh];
    if (has_skin(scene, instance) || mesh.positions.empty()) continue;
    int node = instance.node;
    while (node >= 0 && nodes[node].joint < 0) node = nodes[node].parent;
    if (node < 0) {
      left_out.push_back(mesh.name);
      continue;
    }
    const Affine inverse_bind = nodes[node].global.inverse() * nodes[instance.node].global;
    if (!inverse_bind.matrix().allFinite())
      throw InputError(scene.file, "mesh " + mesh.name, "a joint without extent (scale 0) above it",
                       "a joint that can be inverted");
    Surface& surface = surfaces.emplace_back();
    surface.mesh = &mesh;
    surface.holder = instance.node;
    surface.bindings = {{node, inverse_bind}};
    surface.first.resize(mesh.positions.size() + 1);
    for (std::size_t v = 0; v < surface.first.size(); ++v) surface.first[v] = static_cast<int>(v);
    surface.influences.assign(mesh.positions.size(), {0, 1.0});
    hung.push_back(mesh.name + " (on " + nodes[node].name + ")");
  }
  for (std::size_t m = 0; m < drawn.size(); ++m)
    if (!drawn[m] && !scene.meshes[m].positions.empty()) left_out.push_back(scene.meshes[m].name);
  if (!hung.empty())
    report.notes.push_back(count_of(hung.size(), "mesh") +
                           " without a skin bound rigidly to the joint above: " + list_of(hung));
  if (!left_out.empty())
    report.notes.push_back(count_of(left_out.size(), "mesh") +
                           " without a skin and not on a joint left out: " + list_of(left_out));
  return surfaces;
}

} // namespace tutu::rig::import_detail
