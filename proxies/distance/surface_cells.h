// Points on the surfaces of posed proxies, each the middle of a cell that is known.
#pragma once

#include "proxies/shapes.h"

#include <array>
#include <numbers>
#include <span>
#include <vector>

namespace tutu::proxies {

enum class CapsulePart : std::uint8_t { side, cap_a, cap_b };

/// A rectangle of parameters on a capsule's surface. v: angle about the axis, rad. u: on the side from a (0) to b (1);
/// on a cap the latitude, from that of its rim to pi / 2 at the pole.
struct SurfaceCell {
  int capsule = 0;
  CapsulePart part = CapsulePart::side;
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 2.0 * std::numbers::pi;
};

/// A capsule with axes about it, for turning parameters into points.
class CapsuleSurface {
public:
  explicit CapsuleSurface(const Capsule& capsule);

  double area() const; ///< m2, of all of it, exact
  /// Latitude at which a cap meets the side: 0 without taper, and of opposite signs at both ends (cone_sine).
  double rim(CapsulePart cap) const;
  double slant() const { return cosine_ * length_; }  ///< m, of the side from rim to rim
  double radius_of(CapsulePart cap) const;            ///< m
  double from_axis(CapsulePart part, double u) const; ///< m

  Vec3 middle(const SurfaceCell& cell) const; ///< of the parameters; on the surface
  double area(const SurfaceCell& cell) const; ///< m2, exact
  /// No point of the cell is farther from its middle, m. The straight way in (u, v) from the middle is at most
  /// sqrt(du^2 + c^2 dv^2) long, u as length, c being the largest distance from the axis within the cell.
  double radius(const SurfaceCell& cell) const;
  /// The cell in two, across the side that is longer on the surface.
  std::array<SurfaceCell, 2> halves(const SurfaceCell& cell) const;

private:
  double along(const SurfaceCell& cell) const;  ///< m, half the cell's extent in u
  double around(const SurfaceCell& cell) const; ///< m, half its largest extent in v

  Vec3 a_, axis_, x_, y_; ///< axis: from a to b, unit (+Y for a sphere); x, y across it
  double length_;         ///< 0 where one ball is all
  double sine_, cosine_;  ///< of the cone
  double radius_a_, radius_b_;
};

/// Cells about as long as wide, about `count` in all, that cover every capsule's surface: side and two caps, or two
/// caps for a sphere. Rings of equal cells, so that each has nearly the area of the others.
std::vector<SurfaceCell> surface_cells(std::span<const Capsule> capsules, int count);

} // namespace tutu::proxies
