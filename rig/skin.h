// Linear blend skinning.
#pragma once

#include "rig/mesh.h"
#include "rig/skeleton.h"

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace tutu::rig {

/// How the vertices of one mesh hang on joints. A palette slot is a joint together with an inverse bind: skins put in
/// common may bind one joint in two ways.
struct Skin {
  int influences = 4; ///< a vertex has this many (slot, weight) pairs, 4 or 8; unused ones have weight 0 and slot 0
  std::vector<int> slot_joint;               ///< joint of each slot
  std::vector<Eigen::Affine3d> inverse_bind; ///< slot: joint_from_bind; may hold a scale
  std::vector<std::uint16_t> slots;          ///< [vertex * influences + k]
  std::vector<float> weights;                ///< [vertex * influences + k], falling, summing to 1

  int slot_count() const { return static_cast<int>(slot_joint.size()); }
};

/// A skinning matrix of one slot, ready for the kernel: columns x, y, z and translation, each with a fourth unused
/// lane. One cache line: a vector of 16 floats never straddles two.
struct alignas(64) SkinMatrix {
  float columns[4][4];
};

/// palette[slot] = model_from_joint[slot_joint] * inverse_bind. Spans: model has joint_count, palette slot_count
/// entries.
void skinning_palette(const Skin& skin, std::span<const Transform> model, std::span<SkinMatrix> palette);

/// v' = sum_k w_k palette[slot_k] v; n' = the same without translation, normalised (exact for rigid slots; a uniform
/// scale cancels; one that blends to nothing becomes +Y). [Magnenat-Thalmann et al. 1988; Lewis et al. 2000, eq. 1].
/// Outputs have vertex_count entries; `normals` may be empty. Same bits on every processor, and for any range. One
/// thread, SIMD of the processor it runs on (Highway).
void skin_vertices(const Mesh& mesh, const Skin& skin, std::span<const SkinMatrix> palette, std::span<Vec3f> positions,
                   std::span<Vec3f> normals);

/// The same for vertices first..last only: what a thread, or an attachment, asks for.
void skin_vertices(const Mesh& mesh, const Skin& skin, std::span<const SkinMatrix> palette, int first, int last,
                   std::span<Vec3f> positions, std::span<Vec3f> normals);

/// The plain form in double, one vertex after the other: what tests and validation compare with.
void skin_vertices_reference(const Mesh& mesh, const Skin& skin, std::span<const Transform> model,
                             std::span<Vec3> positions, std::span<Vec3> normals);

} // namespace tutu::rig
