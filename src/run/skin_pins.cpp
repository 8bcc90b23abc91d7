#include "src/run/skin_pins.h"

#include "proxies/body/point_triangle.h"

#include <algorithm>
#include <limits>
#include <map>

namespace tutu::app {
namespace {

using Matrix3 = Eigen::Matrix3d;

/// First edge, across it, normal, as columns; the identity for a triangle without area.
Matrix3 frame_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 edge = b - a, normal = edge.cross(c - a);
  const double edge_length = edge.norm(), normal_length = normal.norm();
  if (!(edge_length > 0.0) || !(normal_length > 0.0)) return Matrix3::Identity();
  Matrix3 frame;
  frame.col(0) = edge / edge_length;
  frame.col(2) = normal / normal_length;
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

/// Takes over what the mesh of the bindings needs of the character's, and renames their corners.
void keep_what_is_used(const rig::Character& character, SkinPins& pins) {
  const rig::Skin& whole = character.skin;
  pins.skin.influences = whole.influences;
  pins.skin.method = whole.method;
  std::map<std::uint32_t, std::uint32_t> vertices; // of the character: of pins.mesh
  std::map<std::uint16_t, std::uint16_t> slots;
  for (SkinPins::Binding& binding : pins.bindings)
    for (std::uint32_t& corner : binding.corners) {
      const auto [vertex, is_new] = vertices.try_emplace(corner, static_cast<std::uint32_t>(vertices.size()));
      const std::uint32_t of_character = corner;
      corner = vertex->second;
      if (!is_new) continue;
      pins.mesh.positions.push_back(character.mesh.positions[of_character]);
      pins.mesh.normals.push_back(character.mesh.normals[of_character]);
      if (!whole.centres.empty()) pins.skin.centres.push_back(whole.centres[of_character]);
      for (int k = 0; k < whole.influences; ++k) {
        const std::size_t influence = static_cast<std::size_t>(of_character) * whole.influences + k;
        const std::uint16_t slot = whole.slots[influence];
        const auto [kept, first_use] = slots.try_emplace(slot, static_cast<std::uint16_t>(slots.size()));
        if (first_use) {
          pins.skin.slot_joint.push_back(whole.slot_joint[slot]);
          pins.skin.inverse_bind.push_back(whole.inverse_bind[slot]);
        }
        pins.skin.slots.push_back(kept->second);
        pins.skin.weights.push_back(whole.weights[influence]);
      }
    }
}

} // namespace

SkinPins bind_to_skin(const cloth::Garment& garment, const rig::Character& character) {
  SkinPins pins;
  const auto on_skin = [](const cloth::Attachment& attachment) { return attachment.skin; };
  if (std::none_of(garment.attachments.begin(), garment.attachments.end(), on_skin)) return pins;
  std::vector<Vec3> rest(character.mesh.positions.size()), normals(rest.size());
  rig::skin_vertices_reference(character.mesh, character.skin, rig::rest_model(character.skeleton), rest, normals);
  const std::vector<rig::Triangle>& triangles = character.mesh.triangles;
  for (int k = 0; k < static_cast<int>(garment.pins.size()); ++k) {
    if (!garment.attachments[garment.pins[k].attachment].skin) continue;
    const Vec3& p = garment.rest_positions[garment.pins[k].particle];
    double least = std::numeric_limits<double>::infinity();
    SkinPins::Binding binding;
    binding.pin = k;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const Vec3 &a = rest[triangles[t][0]], &b = rest[triangles[t][1]], &c = rest[triangles[t][2]];
      const proxies::MeshPoint on = proxies::nearest_on_triangle(p, a, b, c);
      if (!(on.distance < least)) continue;
      least = on.distance;
      binding.triangle = t;
      binding.corners = triangles[t];
      binding.weights = on.weights;
      binding.offset = frame_of(a, b, c).transpose() * (p - on.closest);
    }
    pins.bindings.push_back(binding);
  }
  keep_what_is_used(character, pins);
  return pins;
}

Vec3 target_of(const SkinPins::Binding& binding, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3& w = binding.weights;
  return w[0] * a + w[1] * b + w[2] * c + frame_of(a, b, c) * binding.offset;
}

void place_on_skin(const SkinPins& pins, std::span<const Transform> world, SkinPinScratch& scratch,
                   std::span<Vec3> targets) {
  if (pins.bindings.empty()) return;
  scratch.palette.resize(pins.skin.slot_joint.size());
  scratch.positions.resize(pins.mesh.positions.size());
  rig::skinning_palette(pins.skin, world, scratch.palette);
  rig::skin_vertices(pins.mesh, pins.skin, scratch.palette, scratch.positions, {});
  for (const SkinPins::Binding& binding : pins.bindings) {
    const auto corner = [&](int k) { return Vec3(scratch.positions[binding.corners[k]].cast<double>()); };
    targets[binding.pin] = target_of(binding, corner(0), corner(1), corner(2));
  }
}

int main_joint(const SkinPins& pins, const cloth::Garment& garment, int attachment) {
  std::map<int, double> weight_of;
  for (const SkinPins::Binding& binding : pins.bindings) {
    if (garment.pins[binding.pin].attachment != attachment) continue;
    for (int corner = 0; corner < 3; ++corner)
      for (int k = 0; k < pins.skin.influences; ++k) {
        const std::size_t influence = static_cast<std::size_t>(binding.corners[corner]) * pins.skin.influences + k;
        weight_of[pins.skin.slot_joint[pins.skin.slots[influence]]] +=
            binding.weights[corner] * static_cast<double>(pins.skin.weights[influence]);
      }
  }
  const auto by_weight = [](const auto& x, const auto& y) { return x.second < y.second; };
  const auto most = std::max_element(weight_of.begin(), weight_of.end(), by_weight);
  return most == weight_of.end() ? 0 : most->first;
}

} // namespace tutu::app
