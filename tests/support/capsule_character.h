// A whole character file around a body whose shape is known, and scenes that put proxies on it.
#pragma once

#include "rig/io/file_io.h"
#include "rig/mannequin/mannequin.h"
#include "tests/support/capsule_body.h"

#include <filesystem>
#include <fmt/format.h>
#include <string>

namespace tutu::test {

/// Writes `body` as a Collada character: all of it on the joint "Hips", which has a child "LeftArm" that carries no
/// skin. Its joint sphere is a grain inside the first capsule, at `inside`.
inline void write_capsule_character(const std::filesystem::path& file, const CapsuleBody& body, const Vec3& inside,
                                    double grain_radius = 0.01) {
  const auto on_hips = [](const CapsuleBody& shape, rig::Mesh& mesh, rig::Skin& skin) {
    mesh.positions = shape.positions;
    mesh.triangles = shape.triangles;
    mesh.normals = rig::angle_weighted_normals(mesh.positions, mesh.triangles);
    mesh.parts = {{"body", 0, static_cast<std::uint32_t>(mesh.triangles.size()), {0.8f, 0.8f, 0.8f}}};
    skin.slot_joint = {0, 1};
    skin.inverse_bind = {Eigen::Affine3d::Identity(), Eigen::Affine3d(Eigen::Translation3d(-0.3, 0, 0))};
    skin.slots.assign(4 * mesh.positions.size(), 0);
    skin.weights.assign(4 * mesh.positions.size(), 0.0f);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) skin.weights[4 * v] = 1.0f;
  };
  rig::Mannequin character;
  character.skeleton.names = {"Hips", "LeftArm"};
  character.skeleton.parents = {rig::k_no_parent, 0};
  character.skeleton.rest_local = {Transform{}, Transform{Quat::Identity(), Vec3(0.3, 0, 0)}};
  on_hips(body, character.surface, character.surface_skin);
  CapsuleBody grain;
  grain.add({inside, inside + 0.01 * Vec3::UnitY(), grain_radius}, 6, 2, 1);
  on_hips(grain, character.spheres, character.sphere_skin);
  write_file(file, rig::collada_of(character));
}

/// `capsules` on the Hips as a proxies file, named "p0", "p1", ...
inline std::string proxies_json(const std::vector<proxies::Capsule>& capsules) {
  std::string text;
  for (std::size_t k = 0; k < capsules.size(); ++k) {
    const proxies::Capsule& c = capsules[k];
    text += fmt::format(
        "{}{{\"name\": \"p{}\", \"capsule\": {{\"joint\": \"Hips\", \"a\": [{}, {}, {}], \"b\": [{}, {}, "
        "{}], \"radius\": [{}, {}]}}}}",
        k == 0 ? "" : ", ", k, c.a.x(), c.a.y(), c.a.z(), c.b.x(), c.b.y(), c.b.z(), c.radius_at(0), c.radius_at(1));
  }
  return "{\"proxies\": [" + text + "]}";
}

} // namespace tutu::test
