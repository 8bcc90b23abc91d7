// Garments that are held by the skin: their pins ride on its triangles, and only those triangles are skinned.
#pragma once

#include "cloth/garment/garment.h"
#include "rig/character.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tutu::app {

/// How the pins of one garment hang on the character's skin. Immutable.
struct SkinPins {
  /// A point on a triangle plus an offset in the triangle's own frame (first edge; across it within the triangle;
  /// normal), so that at rest it is exactly where it was bound. Where the nearest point is inside the triangle the
  /// offset is along the normal only.
  struct Binding {
    int pin = 0;                            ///< index into Garment::pins
    std::array<std::uint32_t, 3> corners{}; ///< vertices of `mesh`
    Vec3 weights = Vec3::Zero();            ///< barycentric, each in [0, 1]
    Vec3 offset = Vec3::Zero();             ///< m
    std::uint32_t triangle = 0;             ///< of the character's mesh
  };
  std::vector<Binding> bindings;
  rig::Mesh mesh; ///< the vertices of those triangles and no others; no triangles
  rig::Skin skin; ///< of `mesh`, with the slots that it uses and no others
};

/// Binds each pin whose attachment is on the skin to the nearest triangle of the character at rest.
SkinPins bind_to_skin(const cloth::Garment& garment, const rig::Character& character);

/// What place_on_skin works in; sized by the first call.
struct SkinPinScratch {
  std::vector<rig::SkinMatrix> palette;
  std::vector<Vec3f> positions;
};

/// Where the bound pins are for this pose (world_from_joint): writes targets[binding.pin] only. Allocates nothing once
/// the scratch has its size.
void place_on_skin(const SkinPins& pins, std::span<const Transform> world, SkinPinScratch& scratch,
                   std::span<Vec3> targets);

/// The target of one binding, given where its corners are.
Vec3 target_of(const SkinPins::Binding& binding, const Vec3& a, const Vec3& b, const Vec3& c);

/// The joint that carries most of the weight under the pins of `attachment`: what stands for it when a garment is
/// carried along rigidly.
int main_joint(const SkinPins& pins, const cloth::Garment& garment, int attachment);

} // namespace tutu::app
