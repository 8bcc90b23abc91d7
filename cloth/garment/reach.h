// Where a garment can be at all: what of a body, and of its proxies, it could ever touch.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/shapes.h"

#include <span>
#include <vector>

namespace tutu::cloth {

/// Cloth that hangs may be longer than at rest by this factor: over what 99 of 100 threads of the dance give by ten
/// times, though not over the worst of a slit's upper end.
inline constexpr double k_reach_stretch = 1.2;

/// Conservative: a particle is never farther from the pin it hangs on than the cloth between them is long, whatever the
/// motion does (build_tethers), and a point between particles is near one of them. One ball a pin. Immutable.
class GarmentReach {
public:
  explicit GarmentReach(const Garment& garment);

  /// Whether every particle hangs on a pin. If not, nothing bounds the garment and place() appends nothing.
  bool bounded() const { return bounded_; }

  /// Appends the balls (capsules of no length) for pins at these places: world, m, in the order of Garment::pins. All
  /// cloth, with the gap it keeps from colliders, is inside their union.
  void place(std::span<const Vec3> pins, std::vector<proxies::Capsule>& balls) const;

private:
  std::vector<double> radii_; ///< [pin], m
  bool bounded_ = true;
};

} // namespace tutu::cloth
