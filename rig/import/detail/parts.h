// Private to the importer (rig/import/*.cpp): from a FileScene to a character, step by step.
//
// `file` space: that of the FileScene. Node globals are file_from_node as the file has its nodes (the node pose);
// joints rest as Joints::rest says. metres_from_file (Conversion) leads to model space: m, +Y up.
#pragma once

#include "rig/character.h"
#include "rig/import/detail/file_scene.h"
#include "rig/import/import.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tutu::rig::import_detail {

/// What a file is read for: which formats will do, and what messages say was expected.
enum class Purpose { character, surface };

/// The size of the file in bytes. Throws InputError when it is missing, empty, too large or not of an accepted format.
std::uintmax_t check_acceptable(const std::filesystem::path& file, Purpose purpose = Purpose::character);

/// Reads an acceptable file by the reader of its format. Throws InputError when that cannot.
FileScene read_scene_of(const std::filesystem::path& file, Purpose purpose = Purpose::character);

/// A linear map as rotation * stretch: the polar decomposition, the rotation proper (a mirrored map has a stretch with
/// negative determinant).
struct Polar {
  Quat rotation;
  Matrix3 stretch;
};
Polar polar(const Matrix3& linear);
bool is_uniform(const Matrix3& stretch); ///< a multiple of the identity, to 1e-3

struct Node {
  std::string name;
  int parent = -1;
  Affine local, global;                    ///< parent_from_node, file_from_node
  Polar split;                             ///< of the global's linear part
  bool holds_mesh = false, is_aid = false; ///< an aid is a camera or a light
  int joint = -1;                          ///< of the skeleton; several nodes may be one joint
};

/// All nodes, parent before child. Throws InputError on transforms that multiply to what is no number.
std::vector<Node> walk(const FileScene& scene);

/// A mesh of the file and what moves it. The influences of vertex v are influences[first[v]] up to influences[first[v +
/// 1]], with weights > 0 that sum to 1.
struct Surface {
  const FileMesh* mesh = nullptr;
  int holder = -1; ///< the node that draws it
  Affine bind_shape = Affine::Identity();
  std::vector<Binding> bindings;
  std::vector<int> first;
  std::vector<Influence> influences;
  int dominant = 0; ///< the binding with the largest sum of weights
};

/// The meshes that hang on a skin. Throws InputError when there is none.
std::vector<Surface> skinned_surfaces(const FileScene& scene, const std::vector<Node>& nodes, ImportReport& report);

/// The meshes without a skin that hang on a joint, bound to it rigidly; the others are left out. Both are noted.
/// Needs Node::joint.
std::vector<Surface> rigid_surfaces(const FileScene& scene, const std::vector<Node>& nodes, ImportReport& report);

/// The joints of the character, hierarchies put in common.
struct Joints {
  std::vector<std::string> names;
  std::vector<int> parents;
  std::vector<int> nodes;      ///< the node whose place and animation the joint follows
  std::vector<Transform> rest; ///< file_from_joint, without scale
};
/// Sets Node::joint; joints rest as their nodes stand.
Joints choose_joints(const FileScene& scene, std::vector<Node>& nodes, const std::vector<Surface>& surfaces,
                     ImportReport& report);
/// Puts the joints where their skins were bound, and those without a skin where these carry them. They stay as they are
/// where binding says nothing about them: bones that are not as long as the nodes', or points in place of bones.
void rest_in_bind_pose(const std::vector<Node>& nodes, const std::vector<Surface>& surfaces, Joints& joints,
                       ImportReport& report);

/// file_from_vertex of one binding with its joint at rest.
Affine carried_at_rest(const std::vector<Node>& nodes, const Joints& joints, const Binding& binding);

/// From file space to model space: x -> rotation * (scale * x).
struct Conversion {
  double scale = 1.0;
  Quat rotation = Quat::Identity();

  Transform operator*(const Transform& file_from_joint) const {
    return {(rotation * file_from_joint.rotation).normalized(), rotation * (scale * file_from_joint.translation)};
  }
};
/// From what the file and the options say, else from the skinned rest pose; `surfaces` are those with a skin. Fills
/// unit, up axis and height of the report. Throws InputError on a body that is none.
Conversion choose_conversion(const FileScene& scene, const std::vector<Node>& nodes, const Joints& joints,
                             const std::vector<Surface>& surfaces, const ImportOptions& options, ImportReport& report);

Skeleton build_skeleton(const std::string& file, const Joints& joints, const Conversion& conversion);

/// Fills mesh and skin of the character; its skeleton is there.
void build_mesh(const std::vector<Node>& nodes, const std::vector<Surface>& surfaces, const Conversion& conversion,
                const ImportOptions& options, Character& character, ImportReport& report);

std::vector<ChannelClip> build_clips(const FileScene& scene, const std::vector<Node>& nodes, const Joints& joints,
                                     const Conversion& conversion, ImportReport& report);

/// Names of joints, mesh parts and clips as plain text, told apart as before; noted. The rest of the report's text too.
void clean_names(Import& import);

/// Does an animation of the file move this node away from where it stands?
bool is_moved(const FileScene& scene, const std::vector<Node>& nodes, int node);

/// "3 joints", "1 joint".
std::string count_of(std::size_t count, const std::string& noun);
/// "a, b, c and 4 more".
std::string list_of(const std::vector<std::string>& names, std::size_t most = 6);

} // namespace tutu::rig::import_detail
