// A FileScene evaluated, in double: what it draws at rest and in its animations.
#pragma once

#include "rig/import/detail/file_scene.h"

#include <vector>

namespace tutu::test {

/// Corners of all triangles drawn, three a triangle, instance by instance; the file's space. `animation` -1: as the
/// nodes stand.
inline std::vector<Vec3> scene_corners(const rig::import_detail::FileScene& scene, int animation, double time) {
  using namespace rig::import_detail;
  std::vector<Affine> locals;
  for (const FileNode& node : scene.nodes) locals.push_back(node.local);
  if (animation >= 0)
    for (const NodeMotion& motion : scene.animations.at(static_cast<std::size_t>(animation)).nodes) {
      Affine& local = locals.at(static_cast<std::size_t>(motion.node));
      Matrix3 rotation, scale;
      local.computeRotationScaling(&rotation, &scale);
      const Vec3 move = motion.translation.empty() ? Vec3(local.translation()) : value_at(motion.translation, time);
      if (!motion.rotation.empty()) rotation = value_at(motion.rotation, time).toRotationMatrix();
      if (!motion.scale.empty()) scale = value_at(motion.scale, time).asDiagonal();
      local.linear() = rotation * scale;
      local.translation() = move;
    }
  std::vector<Affine> globals;
  for (std::size_t n = 0; n < scene.nodes.size(); ++n)
    globals.push_back(n == 0 ? locals[0] : globals.at(static_cast<std::size_t>(scene.nodes[n].parent)) * locals[n]);

  std::vector<Vec3> corners;
  for (const FileInstance& instance : scene.instances) {
    const FileMesh& mesh = scene.meshes.at(static_cast<std::size_t>(instance.mesh));
    std::vector<Vec3> points;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 point = mesh.positions[v].cast<double>();
      Vec3 sum = Vec3::Zero();
      double weight = 0.0;
      for (int i = instance.skin.empty() ? 0 : mesh.first.at(v); !instance.skin.empty() && i < mesh.first.at(v + 1);
           ++i) {
        const Influence& influence = mesh.influences.at(static_cast<std::size_t>(i));
        const Binding& binding = instance.skin.at(static_cast<std::size_t>(influence.binding));
        sum += influence.weight * (globals.at(static_cast<std::size_t>(binding.node)) * (binding.inverse_bind * point));
        weight += influence.weight;
      }
      points.push_back(instance.skin.empty() ? globals.at(static_cast<std::size_t>(instance.node)) * point
                                             : Vec3(sum / weight));
    }
    for (const rig::Triangle& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle) corners.push_back(points.at(v));
  }
  return corners;
}

} // namespace tutu::test
