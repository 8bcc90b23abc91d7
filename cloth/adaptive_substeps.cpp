#include "cloth/adaptive_substeps.h"

#include "cloth/state/tolerances.h"
#include "proxies/motion/collider_motion.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace tutu::cloth {
namespace {

double fastest_pin_way(const FrameInput& input) {
  double way = 0.0;
  for (std::size_t k = 0; k < input.pins_end.size(); ++k)
    way = std::max(way, (input.pins_end[k] - input.pins_start[k]).norm());
  return way;
}

/// Half the angle that collider `c` turns by, rad, at most a quarter turn: beyond it the ends no longer tell the arc.
double half_turn_of(const proxies::SweptColliders& colliders, int c) {
  return colliders.spin.empty() ? 0.0 : std::min(0.5 * colliders.spin[c].norm(), 0.5 * std::numbers::pi);
}

/// Along the arc over a chord.
double arc_over(double chord, double half_turn) {
  return half_turn > 0.0 ? chord * half_turn / std::sin(half_turn) : chord;
}

/// Whether the boxes of the swept collider, grown by `reach`, and of the garment meet.
bool is_near(const proxies::Capsule& start, const proxies::Capsule& end, double reach, const Extent& garment) {
  const Vec3 low = start.a.cwiseMin(start.b).cwiseMin(end.a).cwiseMin(end.b);
  const Vec3 high = start.a.cwiseMax(start.b).cwiseMax(end.a).cwiseMax(end.b);
  return ((low.array() - reach) <= garment.high.array()).all() && ((high.array() + reach) >= garment.low.array()).all();
}

} // namespace

Extent extent_of(const Particles& particles) {
  Extent extent;
  if (particles.positions.empty()) return extent;
  extent.low = extent.high = particles.positions.front();
  for (const Vec3& p : particles.positions) {
    extent.low = extent.low.cwiseMin(p);
    extent.high = extent.high.cwiseMax(p);
  }
  double fastest_squared = 0.0; // m2/s2
  for (const Vec3& v : particles.velocities) fastest_squared = std::max(fastest_squared, v.squaredNorm());
  extent.fastest = std::sqrt(fastest_squared);
  return extent;
}

SubstepPlan plan_substeps(const FrameInput& input, const Extent& garment, double contact_offset) {
  SubstepPlan plan;
  plan.substeps = input.substeps;
  const double cloth_way = std::max(garment.fastest * input.seconds, fastest_pin_way(input));
  double most = input.substeps;
  for (int c = 0; c < input.colliders.size(); ++c) {
    if (!input.colliders.meets(c)) continue;
    const proxies::Capsule &start = input.colliders.start[c], &end = input.colliders.end[c];
    const double half_turn = half_turn_of(input.colliders, c);
    const double chord = proxies::farthest_way(start, end);
    const double bulge = 0.5 * chord * std::tan(0.5 * half_turn); // of the arc beyond its chord
    if (!is_near(start, end, start.widest() + contact_offset + cloth_way + bulge, garment)) continue;
    const double collider_way = arc_over(chord, half_turn);
    const double safe_way = k_safe_share * (start.narrowest() + contact_offset);
    const double needed = std::ceil((collider_way + cloth_way) / safe_way);
    if (!(needed > most)) continue;
    most = needed;
    plan.collider = c;
    plan.collider_way = collider_way;
    plan.cloth_way = cloth_way;
    plan.safe_way = safe_way;
  }
  if (plan.collider < 0) return plan;
  const int bound = std::max(input.substeps, k_most_adaptive_substeps);
  plan.bounded = most > bound;
  plan.substeps = plan.bounded ? bound : static_cast<int>(most);
  return plan;
}

std::string SubstepPlan::reason(const std::string& collider_name) const {
  return fmt::format("{} moves {:.3g} m and the cloth up to {:.3g} m, {:.3g} m a substep is safe{}", collider_name,
                     collider_way, cloth_way, safe_way, bounded ? " (bounded)" : "");
}

} // namespace tutu::cloth
