#include "cloth/garment/reach.h"

#include "cloth/garment/elements.h"

#include <algorithm>

namespace tutu::cloth {

GarmentReach::GarmentReach(const Garment& garment) {
  double longest_edge = 0.0; // a point of a triangle is no farther than that from a corner, stretched as the rest is
  for (const Edge& edge : edges_of(garment.triangles))
    longest_edge = std::max(longest_edge, (garment.rest_positions[edge.a] - garment.rest_positions[edge.b]).norm());
  const double margin = k_reach_stretch * longest_edge + garment.fabric.contact_offset();

  std::vector<int> pin_of(garment.rest_positions.size(), -1);
  for (std::size_t k = 0; k < garment.pins.size(); ++k) pin_of[garment.pins[k].particle] = static_cast<int>(k);
  radii_.assign(garment.pins.size(), margin);
  std::size_t held = garment.pins.size();
  for (const Tether& tether : build_tethers(garment)) {
    double& radius = radii_[pin_of[tether.anchor]];
    radius = std::max(radius, k_reach_stretch * tether.length + margin);
    ++held;
  }
  bounded_ = held == garment.rest_positions.size();
}

void GarmentReach::place(std::span<const Vec3> pins, std::vector<proxies::Capsule>& balls) const {
  if (!bounded_) return;
  for (std::size_t k = 0; k < radii_.size(); ++k) balls.push_back({pins[k], pins[k], radii_[k]});
}

} // namespace tutu::cloth
