// Private to the importer: the reader of glTF 2.0, binary or not, by what the file says.
//
// The JSON is read with nlohmann::json and not by tinygltf: tinygltf 2.7.0 refuses the fallback buffers that
// EXT_meshopt_compression brings, and leaves accessors, sparse data, meshopt and normalisation to its caller.
//
// Read besides the core: KHR_mesh_quantization, EXT_ and KHR_meshopt_compression (streams of version 0),
// KHR_draco_mesh_compression, KHR_node_visibility. A file that requires another extension is refused by its name,
// unless that is one of materials, textures, lights or of VRM, which move no vertex.
#pragma once

#include "rig/import/detail/file_scene.h"

#include <filesystem>

namespace tutu::rig::import_detail {

/// Reads .gltf, .glb or .vrm; which of them it is the content tells. m, +Y up, s.
///
/// - Nodes: node 0, without a name, holds the roots of all scenes; the others follow, parent before child, those of the
///   default scene first (`scene`, or the first there is, or all roots where a file has no scenes). Nodes without a
///   name are "node 7", by the file's index. Cameras and lights are aids.
/// - Only nodes of the default scene draw, and those that KHR_node_visibility hides do not. A primitive is a mesh,
/// drawn once a node that holds it, with the node's skin;
///   the default weights of morph targets are in its positions and normals, and noted. Strips and fans are triangles.
///   Of vertices that several primitives share each mesh has those that it uses.
/// - Animations: each channel by its node. start is 0, end the last key of any channel read. Rotations are unit.
///   Of several keys at one time the last counts from there on (noted); times that fall are refused.
///
/// Throws InputError naming the place by a JSON pointer: on what is malformed, out of range, damaged or not finite, on
/// required extensions that are not read, on versions other than 2, on names that lead out of the file's folder, and
/// where accessors would take more memory than memory_limit.h allows. Other exceptions: std::bad_alloc.
FileScene read_gltf(const std::filesystem::path& file);

} // namespace tutu::rig::import_detail
