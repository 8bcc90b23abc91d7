// Private to the importer: what the reader of FBX's nodes, meshes and skins does not tell of a file.
//
// Everything stays in the file's unit and axes.
#pragma once

#include "rig/import/detail/file_scene.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig::import_detail {

struct FbxMotion {
  /// One a take, in the order of the file; takes that move no model are left out. Empty where it could not be read.
  std::vector<FileAnimation> animations;
  /// parent_from_node as the file says the models stand, by node. assimp 5.2.5 differs where it turns a post-rotation
  /// the wrong way round, and where it heeds rotations and orders that the file says are not active.
  std::map<int, Affine> locals;
  std::string unread; ///< why the motion cannot be read soundly ("of version 6100"); else empty
};

/// The motion that the bytes of an FBX file (binary or text, 7.0 to 7.7) say, curve by curve, on the nodes that its
/// reader has made of it: by name below the same parent, where a reader puts digits behind names to tell them apart.
FbxMotion fbx_motion(std::string_view bytes, const std::vector<FileNode>& nodes);

/// A file in which two models of one name are two all the same, for a reader that goes by names.
struct FbxUniqueNames {
  std::string bytes;                           ///< as long as before
  std::map<std::string, std::string> original; ///< by new name
};
/// Of every further model of a name the last letters become digits: the name's length, and with it every place in the
/// file, stays. None where every name is there once, or the file cannot be read soundly.
std::optional<FbxUniqueNames> with_unique_names(std::string_view bytes);

/// Throws InputError that names two models of one name, if there are such (joints before others) and the file can be
/// read: for a reader that has died of it.
void check_fbx_names(const std::string& file, std::string_view bytes);

} // namespace tutu::rig::import_detail
