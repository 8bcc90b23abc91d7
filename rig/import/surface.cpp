// A surface without joints, read in a process of its own.
#include "rig/import/surface.h"
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <map>

namespace tutu::rig {
namespace {

constexpr const char* k_expected = "a surface of finite triangles";

TriangleSurface surface_of(const import_detail::Source& source) {
  TriangleSurface surface;
  std::map<std::array<double, 3>, std::uint32_t> corners;
  const auto corner = [&](const Vec3& p) {
    if (!p.allFinite()) throw InputError(source.file, "", "a non-finite position", k_expected);
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
          const aiVector3D& p = mesh.mVertices[mesh.mFaces[f].mIndices[k]];
          const Vec3 local(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
          triangle[k] = corner(node.global * local);
        }
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
          surface.triangles.push_back(triangle);
      }
    }
  if (surface.triangles.empty()) throw InputError(source.file, "", "no triangle", k_expected);
  return surface;
}

template <class Archive> void pass(Archive& archive, TriangleSurface& surface) {
  import_detail::pass(archive, surface.positions);
  import_detail::pass(archive, surface.triangles);
}

/// A child that was led astray may have written anything.
void check(const TriangleSurface& surface, const std::string& file) {
  bool sound = true;
  for (const Vec3& p : surface.positions) sound = sound && p.allFinite();
  for (const Triangle& triangle : surface.triangles)
    for (const std::uint32_t v : triangle) sound = sound && v < surface.positions.size();
  if (!sound) throw InputError(file, "", "a file that leads its reader astray", k_expected);
}

} // namespace

TriangleSurface import_surface(const std::filesystem::path& file) {
  using import_detail::Purpose;
  try {
    const std::uintmax_t size = import_detail::check_acceptable(file, Purpose::surface);
    const std::string bytes =
        import_detail::isolated_bytes(file.string(), size, "a surface", [&](import_detail::Packer& packer) {
          TriangleSurface read = surface_of(import_detail::load(file, Purpose::surface));
          pass(packer, read);
        });
    import_detail::Unpacker unpacker(bytes);
    TriangleSurface surface;
    pass(unpacker, surface);
    check(surface, file.string());
    return surface;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) { // as in import_character
    throw InputError(file.string(), "", std::string("a file that cannot be read (") + error.what() + ")", k_expected);
  }
}

} // namespace tutu::rig
