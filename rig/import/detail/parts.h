// Private to the importer (rig/import*.cpp): the file between assimp's form and ours.
//
// `file` space: what assimp gives, in the file's unit and axes (for Collada assimp has already applied <unit> and
// <up_axis>). Node globals are file_from_node at rest. metres_from_file (Conversion) leads to model space: m, +Y up.
#pragma once

#include "rig/character.h"
#include "rig/import/import.h"

#include <Eigen/Geometry>
#include <assimp/matrix4x4.h>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct aiMesh;
struct aiNode;
struct aiScene;
struct aiAnimation;

namespace tutu::rig::import_detail {

using Matrix3 = Eigen::Matrix3d;
using Affine = Eigen::Affine3d;

Affine affine_of(const aiMatrix4x4& matrix);

/// A file read by assimp, triangulated, every index in range.
struct Source {
  std::string file;
  std::shared_ptr<const aiScene> scene;
  std::string format;
  std::optional<double> metres_per_unit; ///< as the file says, if it does
  std::optional<char> up_axis;           ///< 'X', 'Y' or 'Z', as the file says, if it does
  bool already_applied = false;          ///< assimp has put both into the root node
};

/// What a file is read for: which formats will do, and what messages say was expected.
enum class Purpose { character, surface };

/// The size of the file in bytes. Throws InputError when it is missing, empty, too large or not of an accepted format.
std::uintmax_t check_acceptable(const std::filesystem::path& file, Purpose purpose = Purpose::character);

/// Throw InputError on joint and weight indices out of range, on weights that are negative or no number, and on
/// geometry, skins or buffers in another document or outside of the file's folder.
void check_collada(const std::string& file);
void check_gltf(const std::string& file);

/// Reads an acceptable file. Throws InputError when assimp cannot read it.
Source load(const std::filesystem::path& file, Purpose purpose = Purpose::character);

/// A linear map as rotation * stretch: the polar decomposition, the rotation proper (a mirrored map has a stretch with
/// negative determinant).
struct Polar {
  Quat rotation;
  Matrix3 stretch;
};
Polar polar(const Matrix3& linear);
bool is_uniform(const Matrix3& stretch); ///< a multiple of the identity, to 1e-3

struct Node {
  const aiNode* source = nullptr;
  std::string name;
  int parent = -1;
  Affine local, global;                    ///< parent_from_node, file_from_node; at rest
  Polar split;                             ///< of the global's linear part
  bool holds_mesh = false, is_aid = false; ///< an aid is a camera or a light
  int joint = -1;                          ///< of the skeleton; several nodes may be one joint
};

/// All nodes, parent before child. Throws InputError on non-finite transforms.
std::vector<Node> walk(const Source& source);

/// One way a mesh hangs on a node: file = sum_k w_k global_k inverse_bind_k vertex.
struct Binding {
  int node = -1;
  Affine inverse_bind; ///< node_from_vertex
};
struct Influence {
  int binding = -1;
  double weight = 0.0;
};

/// A mesh of the file and what moves it. The influences of vertex v are influences[first[v]] up to influences[first[v +
/// 1]], with weights > 0 that sum to 1.
struct Surface {
  const aiMesh* mesh = nullptr;
  std::string name;
  std::vector<Binding> bindings;
  std::vector<int> first;
  std::vector<Influence> influences;
  int dominant = 0; ///< the binding with the largest sum of weights
};

/// The meshes that have bones. Throws InputError when there is none, on indices or weights out of range, non-finite
/// numbers.
std::vector<Surface> skinned_surfaces(const Source& source, const std::vector<Node>& nodes, ImportReport& report);

/// The meshes without bones that hang on a joint, bound to it rigidly; the others are left out. Both are noted.
/// Needs Node::joint.
std::vector<Surface> rigid_surfaces(const Source& source, const std::vector<Node>& nodes, ImportReport& report);

/// The joints of the character, hierarchies put in common; sets Node::joint.
struct Joints {
  std::vector<std::string> names;
  std::vector<int> parents;
  std::vector<int> nodes; ///< the node whose rest and animation the joint follows
};
Joints choose_joints(const Source& source, std::vector<Node>& nodes, const std::vector<Surface>& surfaces,
                     ImportReport& report);

/// From file space to model space: x -> rotation * (scale * x).
struct Conversion {
  double scale = 1.0;
  Quat rotation = Quat::Identity();
};
/// From what the file says, else from the skinned rest pose. Fills unit, up axis and height of the report.
Conversion choose_conversion(const Source& source, const std::vector<Node>& nodes, const Joints& joints,
                             const std::vector<Surface>& surfaces, ImportReport& report);

Skeleton build_skeleton(const Source& source, const std::vector<Node>& nodes, const Joints& joints,
                        const Conversion& conversion);

/// Fills mesh and skin of the character; its skeleton is there.
void build_mesh(const Source& source, const std::vector<Node>& nodes, const std::vector<Surface>& surfaces,
                const Conversion& conversion, const ImportOptions& options, Character& character, ImportReport& report);

std::vector<RawClip> build_clips(const Source& source, const std::vector<Node>& nodes, const Joints& joints,
                                 const Conversion& conversion, ImportReport& report);

/// Textures are never opened; those that stand outside of the file's folder are noted.
void note_outside_textures(const Source& source, ImportReport& report);

/// Names of joints, mesh parts and clips as plain text, told apart as before; noted. The rest of the report's text too.
void clean_names(Import& import);

/// Does an animation of the file move this node away from its rest transform?
bool is_moved(const Source& source, const Node& node);

/// "3 joints", "1 joint".
std::string count_of(std::size_t count, const std::string& noun);
/// "a, b, c and 4 more".
std::string list_of(const std::vector<std::string>& names, std::size_t most = 6);

} // namespace tutu::rig::import_detail
