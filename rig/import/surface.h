// A surface from a file, without joints: what imported garments are made of.
#pragma once

#include "rig/math.h"
#include "rig/mesh.h"

#include <filesystem>
#include <vector>

namespace tutu::rig {

/// Positions in the file's own axes and unit, no two the same: corners that differ only in a normal or a texture
/// coordinate are one.
struct TriangleSurface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles; ///< counter-clockwise seen from the front, as in the file
};

/// All triangles of an .obj, .ply, .stl, .gltf or .glb file (by assimp), each mesh where the file's nodes put
/// it. Materials are never opened. Throws InputError on anything else: missing, empty, truncated or hostile files, no
/// triangle, points that are not finite or beyond +-k_largest_number; and as import_character() does on files outside.
TriangleSurface import_surface(const std::filesystem::path& file);

} // namespace tutu::rig
