#include "proxies/surface_cells.h"

#include <algorithm>
#include <cmath>

namespace tutu::proxies {
namespace {

constexpr double k_pi = std::numbers::pi;

int parts_of(double extent, double spacing) { return std::max(1, static_cast<int>(std::lround(extent / spacing))); }

void add_ring(std::vector<SurfaceCell>& cells, SurfaceCell ring, double circumference, double spacing) {
  const int parts = std::max(3, parts_of(circumference, spacing));
  for (int k = 0; k < parts; ++k) {
    ring.v0 = 2.0 * k_pi * k / parts;
    ring.v1 = 2.0 * k_pi * (k + 1) / parts;
    cells.push_back(ring);
  }
}

} // namespace

CapsuleSurface::CapsuleSurface(const Capsule& capsule)
    : a_(capsule.a), axis_(capsule.b - capsule.a), length_(axis_.norm()), radius_(capsule.radius) {
  axis_ = length_ > 0.0 ? Vec3(axis_ / length_) : Vec3::UnitY();
  int least = 0;
  axis_.cwiseAbs().minCoeff(&least);
  x_ = axis_.cross(Vec3::Unit(least)).normalized();
  y_ = axis_.cross(x_);
}

Vec3 CapsuleSurface::middle(const SurfaceCell& cell) const {
  const double u = 0.5 * (cell.u0 + cell.u1), v = 0.5 * (cell.v0 + cell.v1);
  const Vec3 out = std::cos(v) * x_ + std::sin(v) * y_;
  if (cell.part == CapsulePart::side) return a_ + u * length_ * axis_ + radius_ * out;
  const bool at_b = cell.part == CapsulePart::cap_b;
  const Vec3 centre = at_b ? Vec3(a_ + length_ * axis_) : a_;
  return centre + radius_ * (std::cos(u) * out + (at_b ? 1.0 : -1.0) * std::sin(u) * axis_);
}

double CapsuleSurface::area(const SurfaceCell& cell) const {
  const double angle = cell.v1 - cell.v0;
  if (cell.part == CapsulePart::side) return (cell.u1 - cell.u0) * length_ * angle * radius_;
  return radius_ * radius_ * angle * (std::sin(cell.u1) - std::sin(cell.u0));
}

double CapsuleSurface::along(const SurfaceCell& cell) const {
  return 0.5 * (cell.u1 - cell.u0) * (cell.part == CapsulePart::side ? length_ : radius_);
}

double CapsuleSurface::around(const SurfaceCell& cell) const {
  const double widest = cell.part == CapsulePart::side ? 1.0 : std::cos(cell.u0);
  return 0.5 * (cell.v1 - cell.v0) * radius_ * widest;
}

double CapsuleSurface::radius(const SurfaceCell& cell) const { return std::hypot(along(cell), around(cell)); }

std::array<SurfaceCell, 2> CapsuleSurface::halves(const SurfaceCell& cell) const {
  std::array<SurfaceCell, 2> result = {cell, cell};
  if (along(cell) > around(cell)) result[0].u1 = result[1].u0 = 0.5 * (cell.u0 + cell.u1);
  else result[0].v1 = result[1].v0 = 0.5 * (cell.v0 + cell.v1);
  return result;
}

std::vector<SurfaceCell> surface_cells(std::span<const Capsule> capsules, int count) {
  double whole = 0.0;
  for (const Capsule& c : capsules) whole += 2.0 * k_pi * c.radius * (2.0 * c.radius + (c.b - c.a).norm());
  std::vector<SurfaceCell> cells;
  if (!(whole > 0.0)) return cells;
  const double spacing = std::sqrt(whole / std::max(1, count));
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    const double r = capsules[i].radius, length = (capsules[i].b - capsules[i].a).norm();
    SurfaceCell ring;
    ring.capsule = static_cast<int>(i);
    const int rings = length > 0.0 ? parts_of(length, spacing) : 0;
    for (int k = 0; k < rings; ++k) {
      ring.u0 = static_cast<double>(k) / rings;
      ring.u1 = static_cast<double>(k + 1) / rings;
      add_ring(cells, ring, 2.0 * k_pi * r, spacing);
    }
    const int bands = parts_of(0.5 * k_pi * r, spacing);
    for (const CapsulePart part : {CapsulePart::cap_a, CapsulePart::cap_b})
      for (int k = 0; k < bands; ++k) {
        ring.part = part;
        ring.u0 = 0.5 * k_pi * k / bands;
        ring.u1 = 0.5 * k_pi * (k + 1) / bands;
        add_ring(cells, ring, 2.0 * k_pi * r * std::cos(0.5 * (ring.u0 + ring.u1)), spacing);
      }
  }
  return cells;
}

} // namespace tutu::proxies
