#include "cloth/damping.h"

#include "cloth/garment/elements.h"

#include <algorithm>

namespace tutu::cloth {

Damping::Damping(const Garment& garment) : time_(garment.fabric.damping) {
  constexpr double k_load = 2.0 * 9.81; // m/s2
  double longest = 0.0;                 // m
  for (const Tether& tether : build_tethers(garment)) longest = std::max(longest, tether.length);
  if (garment.pins.empty()) // nothing holds it: how far its own ends can be
    for (const Vec3& p : garment.rest_positions)
      longest = std::max(longest, (p - garment.rest_positions.front()).norm());
  elastic_ = k_load * garment.fabric.density * longest / garment.fabric.stretch;
}

DampedStep Damping::at(double h) const { return {h < time_ ? h / time_ : 1.0, elastic_}; }

} // namespace tutu::cloth
