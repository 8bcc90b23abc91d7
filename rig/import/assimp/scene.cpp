// assimp's scene as ours: nodes, meshes, bones to nodes, weights checked.
#include "rig/error.h"
#include "rig/import/assimp/load.h"
#include "rig/import/detail/parts.h"
#include "rig/import/detail/reach.h"

#include <algorithm>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <cmath>
#include <limits>
#include <set>

namespace tutu::rig::import_detail {
namespace {

constexpr std::size_t k_most_nodes = 100'000;
constexpr unsigned k_most_vertices = 20'000'000;

Affine affine_of(const aiMatrix4x4& m) {
  Affine result = Affine::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      result(r, c) = static_cast<double>(m[static_cast<unsigned>(r)][static_cast<unsigned>(c)]);
  return result;
}
Vec3f vector_of(const aiVector3D& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::string found_in(const std::map<std::string, std::string>& names, const std::string& name) {
  const auto found = names.find(name);
  return found == names.end() ? name : found->second;
}

/// One scene on its way from assimp's form to ours.
class Translator {
public:
  Translator(const aiScene& from, const std::string& file, const NodeNames& names)
      : from_(from), names_(names), file_(file) {
    scene_.file = file_;
  }

  FileScene take(std::map<std::string, int>* node_of) {
    add_nodes(node_of);
    for (unsigned m = 0; m < from_.mNumMeshes; ++m) add_mesh(m);
    note_outside_textures();
    return std::move(scene_);
  }

private:
  void add_nodes(std::map<std::string, int>* node_of) {
    std::set<std::string> aids;
    for (unsigned i = 0; i < from_.mNumCameras; ++i) aids.insert(from_.mCameras[i]->mName.C_Str());
    for (unsigned i = 0; i < from_.mNumLights; ++i) aids.insert(from_.mLights[i]->mName.C_Str());
    holders_.resize(from_.mNumMeshes);
    std::vector<std::pair<const aiNode*, int>> open = {{from_.mRootNode, -1}};
    while (!open.empty()) {
      const auto [node, parent] = open.back();
      open.pop_back();
      const std::string name = node->mName.C_Str();
      const int index = static_cast<int>(scene_.nodes.size());
      const FileNode& own = scene_.nodes.emplace_back(
          FileNode{found_in(names_.shown, name), parent, affine_of(node->mTransformation), aids.contains(name)});
      if (!own.local.matrix().allFinite())
        throw InputError(file_, "node " + own.name, "a non-finite transform", "finite numbers");
      if (scene_.nodes.size() > k_most_nodes)
        throw InputError(file_, "", "more than " + std::to_string(k_most_nodes) + " nodes", "fewer");
      globals_.push_back(parent < 0 ? own.local : globals_[parent] * own.local);
      by_name_.emplace(found_in(names_.in_skins, name), index);
      if (node_of) node_of->try_emplace(name, index);
      for (unsigned i = 0; i < node->mNumMeshes; ++i)
        if (node->mMeshes[i] < from_.mNumMeshes) holders_[node->mMeshes[i]].push_back(index);
      for (unsigned i = node->mNumChildren; i-- > 0;) open.emplace_back(node->mChildren[i], index);
    }
  }

  void add_mesh(unsigned m) {
    const aiMesh& from = *from_.mMeshes[m];
    FileMesh& mesh = scene_.meshes.emplace_back();
    mesh.name = from.mName.length > 0 ? from.mName.C_Str() : "mesh " + std::to_string(m + 1);
    mesh.colour = colour_of(from);
    add_geometry(from, mesh);
    if (from.mNumBones == 0 || from.mNumVertices == 0) {
      for (const int holder : holders_[m]) scene_.instances.push_back({static_cast<int>(m), holder});
      return;
    }
    const int holder = holders_[m].empty() ? 0 : holders_[m].front(); // its skin puts it in place, wherever it hangs
    scene_.instances.push_back({static_cast<int>(m), holder, add_skin(from, mesh, holders_[m])});
  }

  void add_geometry(const aiMesh& from, FileMesh& mesh) const {
    const std::string place = "mesh " + mesh.name;
    if (from.mNumVertices > k_most_vertices)
      throw InputError(file_, place, count_of(from.mNumVertices, "vertex"),
                       "at most " + std::to_string(k_most_vertices));
    for (unsigned v = 0; v < from.mNumVertices; ++v) {
      mesh.positions.push_back(vector_of(from.mVertices[v]));
      if (!mesh.positions.back().allFinite())
        throw InputError(file_, place, "a non-finite position of vertex " + std::to_string(v), "finite numbers");
    }
    for (unsigned v = 0; from.mNormals && v < from.mNumVertices; ++v)
      mesh.normals.push_back(vector_of(from.mNormals[v]));
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
      const aiFace& face = from.mFaces[f];
      if (face.mNumIndices == 3) mesh.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
      else ++mesh.loose;
    }
  }

  /// Fills the mesh's influences; returns what they are bound to.
  std::vector<Binding> add_skin(const aiMesh& from, FileMesh& mesh, const std::vector<int>& holders) {
    Eigen::AlignedBox3d box;
    for (const Vec3f& p : mesh.positions) box.extend(p.cast<double>());
    std::vector<Binding> skin;
    std::vector<std::vector<Influence>> of_vertex(mesh.positions.size());
    std::vector<std::string> nowhere;
    for (unsigned b = 0; b < from.mNumBones; ++b) {
      const aiBone& bone = *from.mBones[b];
      const std::string name = found_in(names_.shown, bone.mName.C_Str());
      const std::string place = "mesh " + mesh.name + ", bone " + name;
      const bool weighs = add_weights(bone, static_cast<int>(skin.size()), place, of_vertex);
      const Affine inverse_bind = affine_of(bone.mOffsetMatrix);
      if (!inverse_bind.matrix().allFinite())
        throw InputError(file_, place, "a non-finite inverse bind matrix", "finite numbers");
      const int node = node_of_bone(bone, inverse_bind, holders, box);
      if (node < 0 && weighs)
        throw InputError(file_, place, "a bone without a node of its name",
                         "a joint in the scene for each bone with weights");
      if (node < 0) nowhere.push_back(name);
      else skin.push_back({node, inverse_bind});
    }
    if (!nowhere.empty())
      scene_.notes.push_back("mesh " + mesh.name + ": " + count_of(nowhere.size(), "bone") +
                             " without weights and without a node left out: " + list_of(nowhere));
    mesh.first = {0};
    for (const std::vector<Influence>& influences : of_vertex) {
      mesh.influences.insert(mesh.influences.end(), influences.begin(), influences.end());
      mesh.first.push_back(static_cast<int>(mesh.influences.size()));
    }
    if (skin.empty() || mesh.influences.empty())
      throw InputError(file_, "mesh " + mesh.name, "bones without any weight", "a skin");
    return skin;
  }

  /// Whether the bone has any.
  bool add_weights(const aiBone& bone, int binding, const std::string& place,
                   std::vector<std::vector<Influence>>& of_vertex) const {
    bool weighs = false;
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const unsigned vertex = bone.mWeights[w].mVertexId;
      const double weight = static_cast<double>(bone.mWeights[w].mWeight);
      if (vertex >= of_vertex.size())
        throw InputError(file_, place, "a weight for vertex " + std::to_string(vertex),
                         "an index below " + std::to_string(of_vertex.size()));
      if (!std::isfinite(weight) || weight < 0.0)
        throw InputError(file_, place, "weight " + std::to_string(weight) + " for vertex " + std::to_string(vertex),
                         "a finite weight, not negative");
      if (!(weight > 0.0)) continue;
      of_vertex[vertex].push_back({binding, weight});
      weighs = true;
    }
    return weighs;
  }

  /// The node a bone means. Of several with its name, the one nearest to where the mesh was bound: the one that leaves
  /// the mesh where the scene's root, or the mesh's own node, has it.
  int node_of_bone(const aiBone& bone, const Affine& inverse_bind, const std::vector<int>& holders,
                   const Eigen::AlignedBox3d& box) const {
    const auto [begin, end] = by_name_.equal_range(found_in(names_.in_skins, bone.mName.C_Str()));
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (auto candidate = begin; candidate != end; ++candidate) {
      const Affine carried = globals_[candidate->second] * inverse_bind;
      double off = distance(carried, globals_[0], box);
      for (const int holder : holders) off = std::min(off, distance(carried, globals_[holder], box));
      if (best < 0 || off < least) {
        best = candidate->second;
        least = off;
      }
    }
    return best;
  }

  /// How far apart two maps carry the corners of a box.
  static double distance(const Affine& a, const Affine& b, const Eigen::AlignedBox3d& box) {
    double largest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      largest = std::max(largest, (a * p - b * p).norm());
    }
    return largest;
  }

  std::array<float, 3> colour_of(const aiMesh& mesh) const {
    const std::array<float, 3> none = FileMesh{}.colour;
    if (mesh.mMaterialIndex >= from_.mNumMaterials) return none;
    const aiMaterial& material = *from_.mMaterials[mesh.mMaterialIndex];
    aiColor4D found;
    if (aiGetMaterialColor(&material, AI_MATKEY_BASE_COLOR, &found) != aiReturn_SUCCESS &&
        aiGetMaterialColor(&material, AI_MATKEY_COLOR_DIFFUSE, &found) != aiReturn_SUCCESS)
      return none;
    if (!std::isfinite(found.r) || !std::isfinite(found.g) || !std::isfinite(found.b)) return none;
    return {std::clamp(found.r, 0.0f, 1.0f), std::clamp(found.g, 0.0f, 1.0f), std::clamp(found.b, 0.0f, 1.0f)};
  }

  /// Textures are not needed and never opened; a file that would have had others' opened is told of.
  void note_outside_textures() {
    const Reach reach(file_);
    std::set<std::string> outside;
    for (unsigned m = 0; m < from_.mNumMaterials; ++m)
      for (int kind = 0; kind <= AI_TEXTURE_TYPE_MAX; ++kind) {
        const auto type = static_cast<aiTextureType>(kind);
        aiString name;
        for (unsigned i = 0; from_.mMaterials[m]->GetTexture(type, i, &name) == aiReturn_SUCCESS; ++i)
          if (!reach.holds_name(name.C_Str())) outside.insert(name.C_Str());
      }
    if (!outside.empty())
      scene_.notes.push_back(count_of(outside.size(), "texture") +
                             " outside of the file's folder not opened: " + list_of({outside.begin(), outside.end()}));
  }

  const aiScene& from_;
  const NodeNames& names_;
  std::string file_;
  FileScene scene_;
  std::vector<Affine> globals_;
  std::vector<std::vector<int>> holders_; ///< [mesh]
  std::multimap<std::string, int> by_name_;
};

} // namespace

FileScene scene_of(const aiScene& from, const std::string& file, const NodeNames& names,
                   std::map<std::string, int>* node_of) {
  return Translator(from, file, names).take(node_of);
}

} // namespace tutu::rig::import_detail
