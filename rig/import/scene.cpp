// From bytes to assimp's scene, and its nodes.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/detail/reach.h"

#include <Eigen/SVD>
#include <algorithm>
#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <map>
#include <set>

namespace tutu::rig::import_detail {
namespace fs = std::filesystem;
namespace {

constexpr const char* k_expected = "a rigged character: .dae, .gltf, .glb, .fbx or .x";
constexpr const char* k_expected_surface = "a surface: .obj, .ply, .stl, .gltf or .glb";
constexpr std::uintmax_t k_largest_file = std::uintmax_t{1} << 30; // bytes
constexpr std::size_t k_most_nodes = 100'000;

/// The formats that carry a skin and whose readers in assimp 5.2.5 stood the tests
/// (tests/rig/import/test_import_hostile.cpp), by the names of assimp's readers. Every other reader is removed, so that
/// no content is ever handed to it.
const std::map<std::string, std::string> k_reader_of = {{".dae", "Collada Importer"},
                                                        {".gltf", "glTF2 Importer"},
                                                        {".glb", "glTF2 Importer"},
                                                        {".fbx", "Autodesk FBX Importer"},
                                                        {".x", "Direct3D XFile Importer"}};
const std::map<std::string, std::string> k_surface_reader_of = {{".obj", "Wavefront Object Importer"},
                                                                {".ply", "Stanford Polygon Library (PLY) Importer"},
                                                                {".stl", "Stereolithography (STL) Importer"},
                                                                {".gltf", "glTF2 Importer"},
                                                                {".glb", "glTF2 Importer"}};

const std::map<std::string, std::string>& readers_for(Purpose purpose) {
  return purpose == Purpose::surface ? k_surface_reader_of : k_reader_of;
}
const char* expected_for(Purpose purpose) { return purpose == Purpose::surface ? k_expected_surface : k_expected; }

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// assimp quotes the file at length, in whatever bytes it has.
std::string readable(std::string reason) {
  constexpr std::size_t k_longest = 160;
  if (reason.find("bad_alloc") != std::string::npos) return "it would take more memory than its size can explain";
  for (char& c : reason)
    if (!std::isprint(static_cast<unsigned char>(c))) c = c == '\n' || c == '\r' || c == '\t' ? ' ' : '?';
  if (reason.size() > k_longest) reason = reason.substr(0, k_longest) + " ...";
  return reason;
}

/// A file may name others. Of these only glTF's buffers are needed, so nothing else is opened (materials of an .obj,
/// say); and of all only regular files of a sane size within reach: a device or a pipe would hang.
class OwnFilesOnly : public Assimp::DefaultIOSystem {
public:
  OwnFilesOnly(const fs::path& model, bool has_buffers) : model_(model), reach_(model), has_buffers_(has_buffers) {}

  bool Exists(const char* name) const override {
    std::error_code error;
    if (!name || (!has_buffers_ && !fs::equivalent(name, model_, error))) return false;
    return reach_.holds(name) && fs::is_regular_file(name, error) && fs::file_size(name, error) <= k_largest_file;
  }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (name && has_buffers_ && !reach_.holds(name)) outside_ = name;
    return mode && *mode == 'r' && Exists(name) ? DefaultIOSystem::Open(name, "rb") : nullptr;
  }

  const std::string& outside() const { return outside_; } ///< a buffer that was asked for out of reach; else empty

private:
  fs::path model_;
  Reach reach_;
  bool has_buffers_;
  std::string outside_;
};

void keep_only_reader(Assimp::Importer& importer, const std::string& name) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    if (description && name == description->mName) continue;
    Assimp::BaseImporter* reader = importer.GetImporter(i);
    importer.UnregisterLoader(reader); // hands ownership over
    delete reader;
  }
}

/// Face indices must be in range before assimp's own triangulation walks them.
void check_indices(const aiScene& scene, const std::string& file) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    const std::string place = "mesh " + std::string(mesh.mName.C_Str());
    if (mesh.mNumVertices > 0 && !mesh.mVertices) throw InputError(file, place, "no positions", k_expected);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned i = 0; i < mesh.mFaces[f].mNumIndices; ++i)
        if (mesh.mFaces[f].mIndices[i] >= mesh.mNumVertices)
          throw InputError(file, place, "vertex index " + std::to_string(mesh.mFaces[f].mIndices[i]),
                           "an index below " + std::to_string(mesh.mNumVertices));
  }
}

template <typename T> std::optional<T> metadata(const aiScene& scene, const char* key) {
  T value{};
  if (scene.mMetaData && scene.mMetaData->Get(key, value)) return value;
  return std::nullopt;
}

std::string version_of(const aiScene& scene) {
  const auto version = metadata<aiString>(scene, AI_METADATA_SOURCE_FORMAT_VERSION);
  return version && version->length > 0 ? " " + std::string(version->C_Str()) : "";
}

std::optional<char> axis_letter(int axis) {
  if (axis < 0 || axis > 2) return std::nullopt;
  return "XYZ"[axis];
}

/// What the file says of unit and up axis; assimp 5.2.5 treats each format in its own way.
void read_conventions(const std::string& extension, Source& source) {
  const aiScene& scene = *source.scene;
  if (extension == ".dae") { // <unit> and <up_axis> are the root node's transform
    source.format = "Collada" + version_of(scene);
    source.already_applied = true;
    const aiMatrix4x4& root = scene.mRootNode->mTransformation;
    const double unit = Vec3(root.a1, root.b1, root.c1).norm();
    if (std::isfinite(unit) && unit > 0.0) source.metres_per_unit = unit;
    int axis = 0;
    Vec3(root.b1, root.b2, root.b3).cwiseAbs().maxCoeff(&axis);
    source.up_axis = axis_letter(axis);
  } else if (extension == ".fbx") { // only told, nothing applied
    source.format = "FBX" + version_of(scene);
    if (const auto factor = metadata<double>(scene, "UnitScaleFactor");
        factor && std::isfinite(*factor) && *factor > 0.0)
      source.metres_per_unit = 0.01 * *factor; // centimetres
    else if (const auto single = metadata<float>(scene, "UnitScaleFactor");
             single && std::isfinite(*single) && *single > 0.0f)
      source.metres_per_unit = 0.01 * static_cast<double>(*single);
    if (const auto axis = metadata<std::int32_t>(scene, "UpAxis")) source.up_axis = axis_letter(*axis);
  } else if (extension == ".x") { // says nothing
    source.format = "DirectX .X";
  } else {
    source.format = "glTF" + version_of(scene) + (extension == ".glb" ? " binary" : "");
    source.metres_per_unit = 1.0;
    source.up_axis = 'Y';
  }
}

} // namespace

Affine affine_of(const aiMatrix4x4& m) {
  Affine result = Affine::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      result(r, c) = static_cast<double>(m[static_cast<unsigned>(r)][static_cast<unsigned>(c)]);
  return result;
}

std::uintmax_t check_acceptable(const fs::path& file, Purpose purpose) {
  const char* expected = expected_for(purpose);
  std::error_code error;
  if (!fs::exists(file, error)) throw InputError(file.string(), "", "no such file", expected);
  if (!fs::is_regular_file(file, error)) throw InputError(file.string(), "", "something that is not a file", expected);
  const std::string extension = lower_extension(file);
  if (!readers_for(purpose).contains(extension))
    throw InputError(file.string(), "", extension.empty() ? "a name without extension" : "a " + extension + " file",
                     expected);
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size == 0) throw InputError(file.string(), "", "an empty file", expected);
  if (size > k_largest_file) throw InputError(file.string(), "", std::to_string(size) + " bytes", "at most 1 GiB");
  return size;
}

Source load(const fs::path& file, Purpose purpose) {
  Source source;
  source.file = file.string();
  const std::string extension = lower_extension(file);
  const bool is_gltf = extension == ".gltf" || extension == ".glb";
  if (extension == ".dae") check_collada(source.file);
  if (is_gltf) check_gltf(source.file);

  const auto importer = std::make_shared<Assimp::Importer>();
  auto* const files = new OwnFilesOnly(file, is_gltf); // owned by the importer
  importer->SetIOHandler(files);
  importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
  importer->SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer->SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true); // else a file without mesh gets one of cones
  keep_only_reader(*importer, readers_for(purpose).at(extension));
  const aiScene* scene = importer->ReadFile(source.file, 0);
  if (!files->outside().empty()) throw out_of_reach(source.file, "", files->outside());
  if (!scene || !scene->mRootNode) {
    throw InputError(source.file, "", "a file that cannot be read (" + readable(importer->GetErrorString()) + ")",
                     expected_for(purpose));
  }
  check_indices(*scene, source.file);
  scene = importer->ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene) throw InputError(source.file, "", "polygons that cannot be triangulated", k_expected);
  source.scene = std::shared_ptr<const aiScene>(importer, scene);
  read_conventions(extension, source);
  return source;
}

Polar polar(const Matrix3& linear) {
  const Eigen::JacobiSVD<Matrix3> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 rotation = svd.matrixU() * svd.matrixV().transpose();
  if (rotation.determinant() < 0.0) rotation = -rotation;
  return {Quat(rotation).normalized(), rotation.transpose() * linear};
}

bool is_uniform(const Matrix3& stretch) {
  const double scale = stretch.trace() / 3.0;
  return (stretch - scale * Matrix3::Identity()).cwiseAbs().maxCoeff() <= 1e-3 * std::abs(scale);
}

std::vector<Node> walk(const Source& source) {
  const aiScene& scene = *source.scene;
  std::set<std::string> aids;
  for (unsigned i = 0; i < scene.mNumCameras; ++i) aids.insert(scene.mCameras[i]->mName.C_Str());
  for (unsigned i = 0; i < scene.mNumLights; ++i) aids.insert(scene.mLights[i]->mName.C_Str());

  std::vector<Node> nodes;
  std::vector<std::pair<const aiNode*, int>> open = {{scene.mRootNode, -1}};
  while (!open.empty()) {
    const auto [from, parent] = open.back();
    open.pop_back();
    Node node;
    node.source = from;
    node.name = from->mName.C_Str();
    node.parent = parent;
    node.local = affine_of(from->mTransformation);
    node.global = parent < 0 ? node.local : nodes[parent].global * node.local;
    if (!node.global.matrix().allFinite())
      throw InputError(source.file, "node " + node.name, "a non-finite transform", "finite numbers");
    node.split = polar(node.global.linear());
    node.holds_mesh = from->mNumMeshes > 0;
    node.is_aid = aids.contains(node.name);
    const int index = static_cast<int>(nodes.size());
    nodes.push_back(std::move(node));
    if (nodes.size() > k_most_nodes)
      throw InputError(source.file, "", "more than " + std::to_string(k_most_nodes) + " nodes", k_expected);
    for (unsigned i = from->mNumChildren; i-- > 0;) open.emplace_back(from->mChildren[i], index);
  }
  return nodes;
}

std::string count_of(std::size_t count, const std::string& noun) {
  if (count == 1) return "1 " + noun;
  return std::to_string(count) + " " + (noun == "vertex" ? "vertices" : noun == "mesh" ? "meshes" : noun + "s");
}

std::string list_of(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i ? ", " : "") + names[i];
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

} // namespace tutu::rig::import_detail
