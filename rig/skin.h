// Skinning: linear blending, and two methods that keep the volume of bent and twisted limbs.
#pragma once

#include "rig/mesh.h"
#include "rig/skeleton.h"

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig {

/// How the motions of several joints become that of a vertex.
enum class Skinning {
  linear,             ///< matrices are blended: fast; limbs lose volume where they bend and twist
  dual_quaternion,    ///< rigid motions are blended [Kavan et al. 2007]: no loss in a twist; bulges where limbs bend
  centres_of_rotation ///< a vertex turns about its own centre [Le and Hodgins 2016]: little loss, less bulge
};
inline constexpr std::array<std::string_view, 3> k_skinning_names{"linear", "dual_quaternion", "centres_of_rotation"};
/// Of one of k_skinning_names.
Skinning skinning_named(std::string_view name);

/// How the vertices of one mesh hang on joints. A palette slot is a joint together with an inverse bind: skins put in
/// common may bind one joint in two ways.
struct Skin {
  int influences = 4; ///< a vertex has this many (slot, weight) pairs, 4 or 8; unused ones have weight 0 and slot 0
  std::vector<int> slot_joint;               ///< joint of each slot
  std::vector<Eigen::Affine3d> inverse_bind; ///< slot: joint_from_bind; may hold a scale
  std::vector<std::uint16_t> slots;          ///< [vertex * influences + k]
  std::vector<float> weights;                ///< [vertex * influences + k], falling, summing to 1
  Skinning method = Skinning::linear;
  std::vector<Vec3f> centres; ///< a vertex: its centre of rotation, bind pose, m; only for that method

  int slot_count() const { return static_cast<int>(slot_joint.size()); }
};

/// Chooses the method, and finds the centres of rotation where it needs them: of each vertex the mean of the surface
/// that the same joints move in the same proportions,
///   p_i = sum_t s(w_i, w_t) a_t c_t / sum_t s(w_i, w_t) a_t over triangles t (area a, centre c, mean weights w),
///   s(w, u) = sum_j<k w_j w_k u_j u_k exp(-((w_j u_k - w_k u_j) / 0.1)^2)
/// [Le and Hodgins 2016]; under a second for a body. Throws InputError (naming `file`) for binds with a
/// scale, which rigid motions cannot hold.
void set_skinning(Skin& skin, const Mesh& mesh, Skinning method, const std::string& file);

/// A skinning matrix of one slot, ready for the kernel: columns x, y, z and translation, each with a fourth lane. Those
/// hold the rotation as a quaternion (x, y, z, w) for methods that need it, else 0. One cache line: a vector of 16
/// floats never straddles two.
struct alignas(64) SkinMatrix {
  float columns[4][4];
};

/// palette[slot] = model_from_joint[slot_joint] * inverse_bind. Spans: model has joint_count, palette slot_count
/// entries.
void skinning_palette(const Skin& skin, std::span<const Transform> model, std::span<SkinMatrix> palette);

/// By the skin's method; linear:
/// v' = sum_k w_k palette[slot_k] v; n' = the same without translation, normalised (exact for rigid slots; a uniform
/// scale cancels; one that blends to nothing becomes +Y). [Magnenat-Thalmann et al. 1988; Lewis et al. 2000, eq. 1].
/// Outputs have vertex_count entries; `normals` may be empty. Same bits on every processor, and for any range. One
/// thread; linear: SIMD of the processor it runs on (Highway), the other methods plain floats, some 5 times as slow.
void skin_vertices(const Mesh& mesh, const Skin& skin, std::span<const SkinMatrix> palette, std::span<Vec3f> positions,
                   std::span<Vec3f> normals);

/// The same for vertices first..last only: what a thread, or an attachment, asks for.
void skin_vertices(const Mesh& mesh, const Skin& skin, std::span<const SkinMatrix> palette, int first, int last,
                   std::span<Vec3f> positions, std::span<Vec3f> normals);

/// The plain form in double, one vertex after the other: what tests and validation compare with.
void skin_vertices_reference(const Mesh& mesh, const Skin& skin, std::span<const Transform> model,
                             std::span<Vec3> positions, std::span<Vec3> normals);

} // namespace tutu::rig
