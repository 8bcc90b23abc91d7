// How the mannequin is made, step by step. Inside of rig/mannequin*.cpp only.
//
//   volumes --march--> fine triangles of the left half --remesh--> even ones --mirrored--> surface
//   volumes, joints, surface --> weights
//
// Plain arithmetic and square roots only, one thread: the same bits at every level of optimisation.
#pragma once

#include "rig/mesh.h"
#include "rig/skeleton.h"
#include "rig/skin.h"

namespace tutu::rig {

/// 52 joints in the rest pose: rest rotations are identity; the character's left is +X.
Skeleton mannequin_skeleton();

/// What moves as one chain of joints; a vertex belongs to the limb whose volume it lies in or nearest to.
enum class BodyChain { trunk, arm, leg, thumb, index, middle, ring, pinky };
inline constexpr int k_chain_count = 8;

/// Signed distance to the body's skin, m, negative inside: exact in sign, about right in size near the skin.
/// `p` is in model space with p.x() >= 0; the other half is the mirror image.
double body_distance(const Vec3& p);

/// The same to one limb of the left half alone.
double chain_distance(BodyChain limb, const Vec3& p);

/// How long triangle edges should be near `p`, m: short where the body is slender or bends.
double edge_length(const Vec3& p);

/// The left half of a surface: x >= 0, open along a loop of vertices in the plane x = 0.
struct HalfSurface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles; ///< counter-clockwise seen from outside
};

/// The zero surface of body_distance by marching tetrahedra: a manifold with boundary, fine and uneven.
HalfSurface march_body();

/// Collapses, splits, flips and shifts until edges are about edge_length long, every vertex on the body's skin;
/// topology stays.
void remesh_body(HalfSurface& half);

/// Weights of the whole surface for the joints, at most four a vertex, mirror images of each other; vertices[i] lies
/// where `mirrored[i]` does but for the sign of x. All binds are at rest.
Skin mannequin_skin(const Skeleton& skeleton, const Mesh& surface, const std::vector<std::uint32_t>& mirrored);

} // namespace tutu::rig
