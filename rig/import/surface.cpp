// A surface without joints, read in a process of its own.
#include "rig/import/surface.h"
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <cstdio>
#include <map>

namespace tutu::rig {
namespace {

std::string place_of(const aiMesh& mesh, unsigned vertex) {
  const std::string name = mesh.mName.C_Str();
  return (name.empty() ? "" : "mesh " + name + ", ") + "vertex " + std::to_string(vertex);
}

std::string shown(const Vec3& p) {
  char text[80];
  std::snprintf(text, sizeof text, "%.9g %.9g %.9g", p.x(), p.y(), p.z());
  return text;
}

TriangleSurface surface_of(const import_detail::Source& source) {
  TriangleSurface surface;
  std::map<std::array<double, 3>, std::uint32_t> corners;
  const auto corner = [&](const Vec3& p) {
    // + 0.0 makes the two zeros one
    const auto next = static_cast<std::uint32_t>(surface.positions.size());
    const auto [place, is_new] = corners.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, next);
    if (is_new) surface.positions.push_back(p);
    return place->second;
  };
  for (const import_detail::Node& node : import_detail::walk(source))
    for (unsigned i = 0; i < node.source->mNumMeshes; ++i) {
      if (node.source->mMeshes[i] >= source.scene->mNumMeshes) continue;
      const aiMesh& mesh = *source.scene->mMeshes[node.source->mMeshes[i]];
      for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        if (mesh.mFaces[f].mNumIndices != 3) continue; // points and lines
        Triangle triangle;
        for (unsigned k = 0; k < 3; ++k) {
          const unsigned vertex = mesh.mFaces[f].mIndices[k];
          const aiVector3D& p = mesh.mVertices[vertex];
          const Vec3 local(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
          const Vec3 placed = node.global * local;
          for (const Vec3& point : {local, placed})
            if (!is_in_bounds(point))
              throw InputError(source.file, place_of(mesh, vertex), "the point " + shown(point),
                               "finite numbers within +-1e9");
          triangle[k] = corner(placed);
        }
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
          surface.triangles.push_back(triangle);
      }
    }
  if (surface.triangles.empty()) throw InputError(source.file, "", "no triangle", import_detail::k_expected_surface);
  return surface;
}

} // namespace

TriangleSurface import_surface(const std::filesystem::path& file) {
  using namespace import_detail;
  try {
    const Bounds bounds = bounds_for(check_acceptable(file, Purpose::surface));
    const std::string answer = isolated_answer(file.string(), bounds, k_expected_surface, [&](Packer& packer) {
      TriangleSurface surface = surface_of(load(file, Purpose::surface));
      pass(packer, surface);
    });
    return unpack_surface(answer, file.string());
  } catch (...) {
    rethrow_as_input_error(file.string(), k_expected_surface);
  }
}

} // namespace tutu::rig
