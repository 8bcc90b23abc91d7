// How many substeps a frame needs so that nothing slips through between two of them.
#pragma once

#include "cloth/solver.h"
#include "cloth/state/particles.h"

#include <string>

namespace tutu::cloth {

/// Where a garment is and how fast: what a plan needs to know of it.
struct Extent {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero(); ///< corners of its bounding box, world, m
  double fastest = 0.0;                         ///< m/s, of any particle
};
Extent extent_of(const Particles& particles);

/// A frame's substeps, and the collider that asked for the most of them.
struct SubstepPlan {
  int substeps = 0;          ///< never fewer than asked
  int collider = -1;         ///< -1: what was asked is safe
  double collider_way = 0.0; ///< m in the frame, of its fastest point
  double cloth_way = 0.0;    ///< m in the frame, of the fastest particle or pin
  double safe_way = 0.0;     ///< m in a substep, of both together
  bool bounded = false;      ///< it would need more than k_most_adaptive_substeps

  bool split(int asked) const { return substeps > asked; }
  /// "collider 4 moves 0.512 m and the cloth up to 0.034 m, 0.031 m a substep is safe"; `collider_name` stands for
  /// "collider 4".
  std::string reason(const std::string& collider_name) const;
};

/// A particle outside a capsule of radius r keeps `contact_offset` from its surface. While collider and particle move
/// against each other by less than r + offset a substep, the particle has not come to the far side of the axis, and is
/// pushed out where it came from. They are let go k_safe_share of that.
///
/// Counted are the colliders whose swept volume comes within reach of the garment in this frame: its box, grown by the
/// cloth's own way. Cloth cannot pass the ground, which is solid to the bottom.
SubstepPlan plan_substeps(const FrameInput& input, const Extent& garment, double contact_offset);

} // namespace tutu::cloth
