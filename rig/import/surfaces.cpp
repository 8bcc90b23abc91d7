// What the file's meshes hang on: bones to nodes, weights checked and normalised.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <algorithm>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <cmath>
#include <limits>
#include <map>

namespace tutu::rig::import_detail {
namespace {

constexpr unsigned k_most_vertices = 20'000'000;

std::string name_of(const aiMesh& mesh, unsigned index) {
  return mesh.mName.length > 0 ? mesh.mName.C_Str() : "mesh " + std::to_string(index + 1);
}

Eigen::AlignedBox3d bounds_of(const aiMesh& mesh, const std::string& file, const std::string& place) {
  if (mesh.mNumVertices > k_most_vertices)
    throw InputError(file, place, count_of(mesh.mNumVertices, "vertex"), "at most " + std::to_string(k_most_vertices));
  Eigen::AlignedBox3d box;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    const Vec3 position(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    if (!position.allFinite())
      throw InputError(file, place, "a non-finite position of vertex " + std::to_string(v), "finite numbers");
    box.extend(position);
  }
  return box;
}

/// Nodes by name, and the nodes that hold each mesh.
struct Index {
  std::multimap<std::string, int> by_name;
  std::vector<std::vector<int>> holders;

  Index(const aiScene& scene, const std::vector<Node>& nodes) : holders(scene.mNumMeshes) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      by_name.emplace(nodes[n].name, static_cast<int>(n));
      for (unsigned i = 0; i < nodes[n].source->mNumMeshes; ++i)
        if (const unsigned mesh = nodes[n].source->mMeshes[i]; mesh < scene.mNumMeshes)
          holders[mesh].push_back(static_cast<int>(n));
    }
  }
};

/// How far apart two maps carry the corners of a box.
double distance(const Affine& a, const Affine& b, const Eigen::AlignedBox3d& box) {
  double largest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    largest = std::max(largest, (a * p - b * p).norm());
  }
  return largest;
}

/// The node a bone means. Of several with its name, the one at rest nearest to where the mesh was bound: the one that
/// leaves the mesh where the scene's root, or the mesh's own node, has it.
int node_of_bone(const aiBone& bone, const Affine& inverse_bind, const std::vector<Node>& nodes, const Index& index,
                 const std::vector<int>& holders, const Eigen::AlignedBox3d& box) {
  const auto [begin, end] = index.by_name.equal_range(bone.mName.C_Str());
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (auto candidate = begin; candidate != end; ++candidate) {
    const Affine carried = nodes[candidate->second].global * inverse_bind;
    double off = distance(carried, nodes[0].global, box);
    for (const int holder : holders) off = std::min(off, distance(carried, nodes[holder].global, box));
    if (best < 0 || off < least) {
      best = candidate->second;
      least = off;
    }
  }
  return best;
}

struct VertexWeight {
  unsigned vertex;
  int binding;
  double weight;
};

void read_weights(const aiBone& bone, int binding, unsigned vertices, const std::string& file, const std::string& place,
                  std::vector<VertexWeight>& weights) {
  for (unsigned w = 0; w < bone.mNumWeights; ++w) {
    const unsigned vertex = bone.mWeights[w].mVertexId;
    const double weight = static_cast<double>(bone.mWeights[w].mWeight);
    if (vertex >= vertices)
      throw InputError(file, place, "a weight for vertex " + std::to_string(vertex),
                       "an index below " + std::to_string(vertices));
    if (!std::isfinite(weight) || weight < 0.0)
      throw InputError(file, place, "weight " + std::to_string(weight) + " for vertex " + std::to_string(vertex),
                       "a finite weight, not negative");
    if (weight > 0.0) weights.push_back({vertex, binding, weight});
  }
}

/// Fills first, influences and dominant; returns how many vertices had no weight and went to the dominant binding.
std::size_t set_influences(Surface& surface, std::vector<VertexWeight> weights) {
  std::vector<double> total(surface.bindings.size(), 0.0), sum(surface.mesh->mNumVertices, 0.0);
  for (const VertexWeight& w : weights) {
    total[w.binding] += w.weight;
    sum[w.vertex] += w.weight;
  }
  surface.dominant = static_cast<int>(std::max_element(total.begin(), total.end()) - total.begin());
  std::size_t bare = 0;
  for (unsigned v = 0; v < sum.size(); ++v) {
    if (sum[v] > 0.0) continue;
    weights.push_back({v, surface.dominant, 1.0});
    sum[v] = 1.0;
    ++bare;
  }
  std::stable_sort(weights.begin(), weights.end(),
                   [](const VertexWeight& a, const VertexWeight& b) { return a.vertex < b.vertex; });
  surface.first.assign(sum.size() + 1, 0);
  for (const VertexWeight& w : weights) {
    ++surface.first[w.vertex + 1];
    surface.influences.push_back({w.binding, w.weight / sum[w.vertex]});
  }
  for (std::size_t v = 0; v < sum.size(); ++v) surface.first[v + 1] += surface.first[v];
  return bare;
}

Surface read_skinned(const Source& source, const std::vector<Node>& nodes, const Index& index, unsigned m,
                     ImportReport& report) {
  const aiMesh& mesh = *source.scene->mMeshes[m];
  Surface surface{.mesh = &mesh, .name = name_of(mesh, m), .bindings = {}, .first = {}, .influences = {}};
  const Eigen::AlignedBox3d box = bounds_of(mesh, source.file, "mesh " + surface.name);
  std::vector<VertexWeight> weights;
  std::vector<std::string> nowhere;
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const std::string place = "mesh " + surface.name + ", bone " + bone.mName.C_Str();
    const std::size_t before = weights.size();
    read_weights(bone, static_cast<int>(surface.bindings.size()), mesh.mNumVertices, source.file, place, weights);
    const Affine inverse_bind = affine_of(bone.mOffsetMatrix);
    if (!inverse_bind.matrix().allFinite())
      throw InputError(source.file, place, "a non-finite inverse bind matrix", "finite numbers");
    const int node = node_of_bone(bone, inverse_bind, nodes, index, index.holders[m], box);
    if (node < 0 && weights.size() > before)
      throw InputError(source.file, place, "a bone without a node of its name",
                       "a joint in the scene for each bone with weights");
    if (node < 0) nowhere.emplace_back(bone.mName.C_Str());
    else surface.bindings.push_back({node, inverse_bind});
  }
  if (!nowhere.empty())
    report.notes.push_back("mesh " + surface.name + ": " + count_of(nowhere.size(), "bone") +
                           " without weights and without a node left out: " + list_of(nowhere));
  if (surface.bindings.empty() || weights.empty())
    throw InputError(source.file, "mesh " + surface.name, "bones without any weight", "a skin");
  if (const std::size_t bare = set_influences(surface, std::move(weights)); bare > 0)
    report.notes.push_back("mesh " + surface.name + ": " + count_of(bare, "vertex") + " without weights bound to " +
                           nodes[surface.bindings[surface.dominant].node].name);
  return surface;
}

} // namespace

std::vector<Surface> skinned_surfaces(const Source& source, const std::vector<Node>& nodes, ImportReport& report) {
  const aiScene& scene = *source.scene;
  if (scene.mNumMeshes == 0) throw InputError(source.file, "", "no mesh", "a mesh with a skin");
  const Index index(scene, nodes);
  std::vector<Surface> surfaces;
  report.file_meshes = static_cast<int>(scene.mNumMeshes);
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    if (scene.mMeshes[m]->mNumBones > 0 && scene.mMeshes[m]->mNumVertices > 0)
      surfaces.push_back(read_skinned(source, nodes, index, m, report));
  if (surfaces.empty())
    throw InputError(source.file, "", count_of(scene.mNumMeshes, "mesh") + " without a skin", "a mesh bound to joints");
  return surfaces;
}

std::vector<Surface> rigid_surfaces(const Source& source, const std::vector<Node>& nodes, ImportReport& report) {
  const aiScene& scene = *source.scene;
  const Index index(scene, nodes);
  std::vector<Surface> surfaces;
  std::vector<std::string> hung, left_out;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (mesh.mNumBones > 0 || mesh.mNumVertices == 0) continue;
    const std::string name = name_of(mesh, m);
    if (index.holders[m].empty()) left_out.push_back(name);
    for (const int holder : index.holders[m]) {
      int node = holder;
      while (node >= 0 && nodes[node].joint < 0) node = nodes[node].parent;
      if (node < 0) {
        left_out.push_back(name);
        continue;
      }
      const Affine inverse_bind = nodes[node].global.inverse() * nodes[holder].global;
      if (!inverse_bind.matrix().allFinite())
        throw InputError(source.file, "mesh " + name, "a joint without extent (scale 0) above it",
                         "a joint that can be inverted");
      bounds_of(mesh, source.file, "mesh " + name);
      Surface surface{.mesh = &mesh, .name = name, .bindings = {{node, inverse_bind}}, .first = {}, .influences = {}};
      set_influences(surface, {});
      surfaces.push_back(std::move(surface));
      hung.push_back(name + " (on " + nodes[node].name + ")");
    }
  }
  if (!hung.empty())
    report.notes.push_back(count_of(hung.size(), "mesh") +
                           " without a skin bound rigidly to the joint above: " + list_of(hung));
  if (!left_out.empty())
    report.notes.push_back(count_of(left_out.size(), "mesh") +
                           " without a skin and not on a joint left out: " + list_of(left_out));
  return surfaces;
}

} // namespace tutu::rig::import_detail
