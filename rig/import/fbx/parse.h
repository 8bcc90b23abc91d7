// Private to the importer: the two forms of an FBX file.
#pragma once

#include "rig/import/fbx/tree.h"

namespace tutu::rig::import_detail {

inline constexpr int k_deepest_element = 100; ///< user's own data included; what is looked for is 5 deep
inline constexpr std::string_view k_binary_start("Kaydara FBX Binary  \0", 21);

/// Is an element kept, or its place alone looked at? Meshes and pictures are most of a file. `parent`: its name; empty
/// at the top.
bool is_of_use(std::string_view parent, std::string_view name);

std::vector<FbxElement> parse_binary_fbx(std::string_view bytes, int& version);
std::vector<FbxElement> parse_text_fbx(std::string_view text, int& version);

} // namespace tutu::rig::import_detail
