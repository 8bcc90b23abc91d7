// A surface without joints, read in a process of its own.
#include "rig/import/surface.h"
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <cstdio>
#include <map>

namespace tutu::rig {
namespace {

std::string place_of(const import_detail::FileMesh& mesh, unsigned vertex) {
  return (mesh.name.empty() ? "" : "mesh " + mesh.name + ", ") + "vertex " + std::to_string(vertex);
}

std::string shown(const Vec3& p) {
  char text[80];
  std::snprintf(text, sizeof text, "%.9g %.9g %.9g", p.x(), p.y(), p.z());
  return text;
}

TriangleSurface surface_of(const import_detail::FileScene& scene) {
  TriangleSurface surface;
  std::map<std::array<double, 3>, std::uint32_t> corners;
  const auto corner = [&](const Vec3& p) {
    // + 0.0 makes the two zeros one
    const auto next = static_cast<std::uint32_t>(surface.positions.size());
    const auto [place, is_new] = corners.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, next);
    if (is_new) surface.positions.push_back(p);
    return place->second;
  };
  const std::vector<import_detail::Node> nodes = import_detail::walk(scene);
  for (const import_detail::FileInstance& instance : scene.instances) {
    const import_detail::FileMesh& mesh = scene.meshes[instance.mesh];
    for (const Triangle& file_triangle : mesh.triangles) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = file_triangle[k];
        const Vec3 local = mesh.positions[vertex].cast<double>();
        const Vec3 placed = nodes[instance.node].global * local;
        for (const Vec3& point : {local, placed})
          if (!is_in_bounds(point))
            throw InputError(scene.file, place_of(mesh, vertex), "the point " + shown(point),
                             "finite numbers within +-1e9");
        triangle[k] = corner(placed);
      }
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
        surface.triangles.push_back(triangle);
    }
  }
  if (surface.triangles.empty()) throw InputError(scene.file, "", "no triangle", import_detail::k_expected_surface);
  return surface;
}

} // namespace

TriangleSurface import_surface(const std::filesystem::path& file) {
  using namespace import_detail;
  try {
    const Bounds bounds = bounds_for(check_acceptable(file, Purpose::surface));
    const std::string answer = isolated_answer(file.string(), bounds, k_expected_surface, [&](Packer& packer) {
      TriangleSurface surface = surface_of(read_scene_of(file, Purpose::surface));
      pass(packer, surface);
    });
    return unpack_surface(answer, file.string());
  } catch (...) {
    rethrow_as_input_error(file.string(), k_expected_surface);
  }
}

} // namespace tutu::rig
