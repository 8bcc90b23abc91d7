// What assimp 5.2.5 makes of each format, and what it leaves to be read from the file itself.
#include "rig/error.h"
#include "rig/import/assimp/assimp.h"
#include "rig/import/assimp/load.h"
#include "rig/import/collada/collada.h"
#include "rig/import/detail/isolated.h"
#include "rig/import/fbx/fbx.h"
#include "rig/io/file_io.h"

#include <assimp/commonMetaData.h>
#include <assimp/scene.h>
#include <cmath>

namespace tutu::rig::import_detail {
namespace fs = std::filesystem;
namespace {

constexpr double k_directx_ticks = 4800.0; ///< a second: what DirectX tools take where the file does not say
constexpr double k_fbx_ticks = 30.0;       ///< a second, where assimp does not say

template <typename T> std::optional<T> metadata(const aiScene& scene, const char* key) {
  T value{};
  if (scene.mMetaData && scene.mMetaData->Get(key, value)) return value;
  return std::nullopt;
}

std::string version_of(const aiScene& scene) {
  const auto version = metadata<aiString>(scene, AI_METADATA_SOURCE_FORMAT_VERSION);
  return version && version->length > 0 ? " " + std::string(version->C_Str()) : "";
}

std::optional<char> axis_letter(std::ptrdiff_t axis) {
  if (axis < 0 || axis > 2) return std::nullopt;
  return "XYZ"[axis];
}

FileScene surface_by(const char* reader, const fs::path& file) {
  const std::string bytes = read_file(file);
  return scene_of(*load(file.string(), bytes, reader, k_expected_surface), file.string());
}

std::shared_ptr<const aiScene> load_fbx(const std::string& file, std::string_view bytes) {
  try {
    return load(file, bytes, "Autodesk FBX Importer", k_expected_character);
  } catch (const InputError&) {
    check_fbx_names(file, bytes); // names that could not be told apart: the likeliest reason
    throw;
  }
}

} // namespace

FileScene read_collada(const fs::path& path) {
  const std::string file = path.string(), bytes = read_file(path);
  const ColladaDocument document(file, bytes);
  check_references(document);
  check_skins(document);
  const std::shared_ptr<const aiScene> from = load(file, bytes, "Collada Importer", k_expected_character);
  std::map<std::string, int> node_of;
  FileScene scene = scene_of(*from, file, {display_names(document), skin_names(document)}, &node_of);
  scene.format = "Collada" + version_of(*from);
  // <unit> and <up_axis> are the root node's transform.
  scene.already_applied = true;
  const aiMatrix4x4& root = from->mRootNode->mTransformation;
  const double unit = Vec3(root.a1, root.b1, root.c1).norm();
  if (std::isfinite(unit) && unit > 0.0) scene.metres_per_unit = unit;
  Eigen::Index axis = 0;
  Vec3(root.b1, root.b2, root.b3).cwiseAbs().maxCoeff(&axis);
  scene.up_axis = axis_letter(axis);

  // Meshes are called by their geometry's id.
  const std::map<std::string, BoundGeometry> geometries = bound_geometries(document);
  for (FileInstance& instance : scene.instances)
    if (const auto geometry = geometries.find(scene.meshes[instance.mesh].name); geometry != geometries.end())
      instance.bind_shape = geometry->second.bind_shape;
  for (FileMesh& mesh : scene.meshes)
    if (const auto geometry = geometries.find(mesh.name);
        geometry != geometries.end() && !geometry->second.name.empty())
      mesh.name = geometry->second.name;
  scene.animations = animations(document, node_of);
  return scene;
}

FileScene read_fbx(const fs::path& path) {
  const std::string file = path.string();
  std::string bytes = read_file(path);
  NodeNames names;
  if (std::optional<FbxUniqueNames> unique = with_unique_names(bytes)) {
    bytes = std::move(unique->bytes);
    names.shown = std::move(unique->original);
  }
  const std::shared_ptr<const aiScene> from = load_fbx(file, bytes);
  FileScene scene = scene_of(*from, file);
  scene.format = "FBX" + version_of(*from);
  // Unit and axes are only told, nothing is applied.
  auto factor = metadata<double>(*from, "UnitScaleFactor");
  if (!factor)
    if (const auto single = metadata<float>(*from, "UnitScaleFactor")) factor = static_cast<double>(*single);
  if (factor && std::isfinite(*factor) && *factor > 0.0) scene.metres_per_unit = 0.01 * *factor; // centimetres
  if (const auto axis = metadata<std::int32_t>(*from, "UpAxis")) scene.up_axis = axis_letter(*axis);

  FbxMotion motion = fbx_motion(bytes, scene.nodes);
  std::vector<bool> holds_mesh(scene.nodes.size(), false); // assimp has put geometric transforms into these
  for (const FileInstance& instance : scene.instances) holds_mesh[instance.node] = true;
  for (const auto& [node, local] : motion.locals)
    if (!holds_mesh[node]) scene.nodes[node].local = local;
  scene.animations = std::move(motion.animations);
  if (!motion.unread.empty()) {
    scene.animations = animations_of(*from, scene, k_fbx_ticks);
    if (!scene.animations.empty())
      scene.notes.push_back("motion " + motion.unread + ": read by its keys alone, with straight lines between them");
  }
  for (FileNode& node : scene.nodes)
    if (const auto original = names.shown.find(node.name); original != names.shown.end()) node.name = original->second;
  return scene;
}

FileScene read_directx(const fs::path& path) {
  const std::string file = path.string(), bytes = read_file(path);
  const std::shared_ptr<const aiScene> from = load(file, bytes, "Direct3D XFile Importer", k_expected_character);
  FileScene scene = scene_of(*from, file); // of unit and axes it says nothing
  scene.format = "DirectX .X";
  for (unsigned a = 0; a < from->mNumAnimations; ++a)
    if (from->mAnimations[a]->mTicksPerSecond == 0.0) {
      scene.notes.push_back("no AnimTicksPerSecond: times read as 4800 ticks a second");
      break;
    }
  scene.animations = animations_of(*from, scene, k_directx_ticks);
  return scene;
}

FileScene read_obj(const fs::path& file) { return surface_by("Wavefront Object Importer", file); }
FileScene read_ply(const fs::path& file) { return surface_by("Stanford Polygon Library (PLY) Importer", file); }
FileScene read_stl(const fs::path& file) { return surface_by("Stereolithography (STL) Importer", file); }

} // namespace tutu::rig::import_detail
