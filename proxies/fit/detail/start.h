// Capsules guessed from points of the skin, and the first layout: one a joint.
#pragma once

#include "proxies/fit/detail/model.h"

namespace tutu::proxies::fit {

/// A point of the skin as a unit sees it: those near a mirror image are folded over to the unit's own side.
struct UnitPoint {
  Vec3 rest = Vec3::Zero(), normal = Vec3::UnitY();
  std::array<int, 4> joints = {};
  std::array<float, 4> weights = {};
  double weight = 0.0; ///< of all poses in which the unit is nearest to it
  double cost = 0.0;   ///< what it costs there
};
UnitPoint unit_point(const SkinPoint& point, bool fold, const BodyMotion& motion);

/// A capsule of a kind along the points' main direction, pulled in along their normals. For a middle or across the
/// points count with their mirror images; `middle` becomes across where they are wider than long. Both
/// radii are equal at first.
Unit capsule_through(std::span<const UnitPoint> points, UnitKind kind, bool tapered, const BodyMotion& motion);

/// The skins of a unit's ends: sums over its points of (1-t)^2 (end a) and t^2 (end b) times the point's weights, t the
/// parameter along the axis at rest. Does not settle.
void take_skins(Unit& unit, std::span<const UnitPoint> points, const BodyMotion& motion);

/// One unit for each joint that owns at least 0.8 % of the samples; the others' go to the joint above.
std::vector<Unit> first_layout(const std::vector<SkinPoint>& skin, const BodyMotion& motion,
                               const rig::Skeleton& skeleton, bool tapered);

} // namespace tutu::proxies::fit
