#include "rig/skin.h"

#include "rig/detail/skin_kernel.h"
#include "rig/detail/skin_rigid.h"

#include <cassert>
#include <cmath>

namespace tutu::rig {

// The kernel reads both as plain floats.
static_assert(sizeof(Vec3f) == 3 * sizeof(float));
static_assert(sizeof(SkinMatrix) == 16 * sizeof(float) && alignof(SkinMatrix) == 64);

namespace {

/// The rotation of a slot that binds rigidly.
Quat slot_rotation(const Transform& joint, const Eigen::Affine3d& inverse_bind) {
  return (joint.rotation * Quat(inverse_bind.linear())).normalized();
}

/// A slot of a palette whose fourth lanes hold its rotation.
skin_detail::Rigid<float> rigid_of(const SkinMatrix& matrix) {
  const auto& c = matrix.columns;
  return {{c[3][3], c[0][3], c[1][3], c[2][3]}, {c[3][0], c[3][1], c[3][2]}};
}

void skin_rigidly(const Mesh& mesh, const Skin& skin, std::span<const SkinMatrix> palette, int first, int last,
                  std::span<Vec3f> positions, std::span<Vec3f> normals) {
  for (int v = first; v < last; ++v) {
    const std::uint16_t* slots = skin.slots.data() + static_cast<std::size_t>(v) * skin.influences;
    const auto rigid = [&](int k) { return rigid_of(palette[slots[k]]); };
    skin_detail::Rotation<float> rotation;
    positions[v] = skin_detail::rigid_point<float>(mesh, skin, v, rigid, rotation);
    if (!normals.empty()) normals[v] = rotation * mesh.normals[v];
  }
}

} // namespace

void skinning_palette(const Skin& skin, std::span<const Transform> model, std::span<SkinMatrix> palette) {
  assert(palette.size() == skin.slot_joint.size());
  for (int slot = 0; slot < skin.slot_count(); ++slot) {
    const Transform& joint = model[skin.slot_joint[slot]];
    const Eigen::Affine3d& inverse_bind = skin.inverse_bind[slot];
    const Eigen::Matrix3d linear = joint.rotation.toRotationMatrix() * inverse_bind.linear();
    const Vec3 translation = joint * Vec3(inverse_bind.translation());
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        palette[slot].columns[column][row] = static_cast<float>(linear(row, column));
      palette[slot].columns[3][row] = static_cast<float>(translation[row]);
    }
    const Quat rotation =
        skin.method == Skinning::linear ? Quat(0.0, 0.0, 0.0, 0.0) : slot_rotation(joint, inverse_bind);
    for (int i = 0; i < 4; ++i) palette[slot].columns[i][3] = static_cast<float>(rotation.coeffs()[i]);
  }
}

void skin_vertices(const Mesh& mesh, const Skin& skin, std::span<const SkinMatrix> palette, std::span<Vec3f> positions,
                   std::span<Vec3f> normals) {
  skin_vertices(mesh, skin, palette, 0, mesh.vertex_count(), positions, normals);
}

void skin_vertices(const Mesh& mesh, const Skin& skin, std::span<const SkinMatrix> palette, int first, int last,
                   std::span<Vec3f> positions, std::span<Vec3f> normals) {
  assert(skin.influences == 4 || skin.influences == 8);
  assert(first >= 0 && last <= mesh.vertex_count());
  assert(positions.size() == mesh.positions.size());
  assert(normals.empty() || (normals.size() == mesh.positions.size() && mesh.normals.size() == normals.size()));
  if (first >= last) return;
  if (skin.method != Skinning::linear) return skin_rigidly(mesh, skin, palette, first, last, positions, normals);
  skin_kernel({.positions = mesh.positions.front().data(),
               .normals = normals.empty() ? nullptr : mesh.normals.front().data(),
               .slots = skin.slots.data(),
               .weights = skin.weights.data(),
               .palette = palette.front().columns[0],
               .influences = skin.influences,
               .first = first,
               .last = last,
               .positions_out = positions.front().data(),
               .normals_out = normals.empty() ? nullptr : normals.front().data()});
}

void skin_vertices_reference(const Mesh& mesh, const Skin& skin, std::span<const Transform> model,
                             std::span<Vec3> positions, std::span<Vec3> normals) {
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (skin.method != Skinning::linear) {
      const auto rigid = [&](int k) {
        const int slot = skin.slots[static_cast<std::size_t>(v) * skin.influences + k];
        const Transform& joint = model[skin.slot_joint[slot]];
        const Eigen::Affine3d& inverse_bind = skin.inverse_bind[slot];
        return skin_detail::Rigid<double>{slot_rotation(joint, inverse_bind), joint * Vec3(inverse_bind.translation())};
      };
      skin_detail::Rotation<double> rotation;
      positions[v] = skin_detail::rigid_point<double>(mesh, skin, v, rigid, rotation);
      if (!normals.empty()) normals[v] = rotation * mesh.normals[v].cast<double>();
      continue;
    }
    const Vec3 rest = mesh.positions[v].cast<double>();
    Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
    for (int k = 0; k < skin.influences; ++k) {
      const int entry = v * skin.influences + k, slot = skin.slots[entry];
      const double weight = skin.weights[entry];
      const Transform& joint = model[skin.slot_joint[slot]];
      position += weight * (joint * (skin.inverse_bind[slot] * rest));
      if (!normals.empty())
        normal += weight * (joint.rotation * (skin.inverse_bind[slot].linear() * mesh.normals[v].cast<double>()));
    }
    positions[v] = position;
    if (normals.empty()) continue;
    const double length = normal.norm();
    normals[v] = length > 1e-15 ? Vec3(normal / length) : Vec3::UnitY();
  }
}

} // namespace tutu::rig
