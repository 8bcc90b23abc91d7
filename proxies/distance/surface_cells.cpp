#include "proxies/distance/surface_cells.h"

#include "proxies/distance/signed_distance.h"

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
    : a_(capsule.a), axis_(capsule.b - capsule.a), length_(axis_.norm()), sine_(cone_sine(capsule)),
      radius_a_(capsule.radius), radius_b_(capsule.radius + capsule.taper) {
  axis_ = length_ > 0.0 ? Vec3(axis_ / length_) : Vec3::UnitY();
  int least = 0;
  axis_.cwiseAbs().minCoeff(&least);
  x_ = axis_.cross(Vec3::Unit(least)).normalized();
  y_ = axis_.cross(x_);
  if (std::abs(sine_) < 1.0) {
    cosine_ = std::sqrt(1.0 - sine_ * sine_);
    return;
  }
  if (sine_ > 0.0) a_ = capsule.b;
  radius_a_ = radius_b_ = capsule.widest();
  length_ = sine_ = 0.0;
  cosine_ = 1.0;
}

double CapsuleSurface::area() const {
  return 2.0 * k_pi *
         (radius_a_ * radius_a_ * (1.0 - std::sin(rim(CapsulePart::cap_a))) +
          radius_b_ * radius_b_ * (1.0 - std::sin(rim(CapsulePart::cap_b))) +
          0.5 * slant() * cosine_ * (radius_a_ + radius_b_));
}

double CapsuleSurface::rim(CapsulePart cap) const { return std::asin(cap == CapsulePart::cap_a ? sine_ : -sine_); }

double CapsuleSurface::radius_of(CapsulePart cap) const { return cap == CapsulePart::cap_a ? radius_a_ : radius_b_; }

double CapsuleSurface::from_axis(CapsulePart part, double u) const {
  if (part == CapsulePart::side) return cosine_ * (radius_a_ + u * (radius_b_ - radius_a_));
  return radius_of(part) * std::cos(u);
}

Vec3 CapsuleSurface::middle(const SurfaceCell& cell) const {
  const double u = 0.5 * (cell.u0 + cell.u1), v = 0.5 * (cell.v0 + cell.v1);
  const Vec3 out = std::cos(v) * x_ + std::sin(v) * y_;
  if (cell.part == CapsulePart::side) {
    const Vec3 normal = cosine_ * out - sine_ * axis_;
    return a_ + u * length_ * axis_ + (radius_a_ + u * (radius_b_ - radius_a_)) * normal;
  }
  const bool at_b = cell.part == CapsulePart::cap_b;
  const Vec3 centre = at_b ? Vec3(a_ + length_ * axis_) : a_;
  return centre + radius_of(cell.part) * (std::cos(u) * out + (at_b ? 1.0 : -1.0) * std::sin(u) * axis_);
}

double CapsuleSurface::area(const SurfaceCell& cell) const {
  const double angle = cell.v1 - cell.v0;
  if (cell.part == CapsulePart::side) // from_axis grows evenly
    return (cell.u1 - cell.u0) * slant() * angle * from_axis(cell.part, 0.5 * (cell.u0 + cell.u1));
  const double r = radius_of(cell.part);
  return r * r * angle * (std::sin(cell.u1) - std::sin(cell.u0));
}

double CapsuleSurface::along(const SurfaceCell& cell) const {
  return 0.5 * (cell.u1 - cell.u0) * (cell.part == CapsulePart::side ? slant() : radius_of(cell.part));
}

double CapsuleSurface::around(const SurfaceCell& cell) const {
  double widest = std::max(from_axis(cell.part, cell.u0), from_axis(cell.part, cell.u1));
  if (cell.part != CapsulePart::side && cell.u0 * cell.u1 < 0.0) widest = radius_of(cell.part); // the equator
  return 0.5 * (cell.v1 - cell.v0) * widest;
}

double CapsuleSurface::radius(const SurfaceCell& cell) const { return std::hypot(along(cell), around(cell)); }

std::array<SurfaceCell, 2> CapsuleSurface::halves(const SurfaceCell& cell) const {
  std::array<SurfaceCell, 2> result = {cell, cell};
  if (along(cell) > around(cell)) result[0].u1 = result[1].u0 = 0.5 * (cell.u0 + cell.u1);
  else result[0].v1 = result[1].v0 = 0.5 * (cell.v0 + cell.v1);
  return result;
}

std::vector<SurfaceCell> surface_cells(std::span<const Capsule> capsules, int count) {
  const std::vector<CapsuleSurface> surfaces(capsules.begin(), capsules.end());
  double whole = 0.0;
  for (const CapsuleSurface& surface : surfaces) whole += surface.area();
  std::vector<SurfaceCell> cells;
  if (!(whole > 0.0)) return cells;
  const double spacing = std::sqrt(whole / std::max(1, count));
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const CapsuleSurface& surface = surfaces[i];
    SurfaceCell ring;
    ring.capsule = static_cast<int>(i);
    const auto add_rings = [&](CapsulePart part, double from, double to, double extent) {
      const int rings = parts_of(extent, spacing);
      ring.part = part;
      for (int k = 0; k < rings; ++k) {
        ring.u0 = from + (to - from) * k / rings;
        ring.u1 = from + (to - from) * (k + 1) / rings;
        const double middle = 0.5 * (ring.u0 + ring.u1);
        add_ring(cells, ring, 2.0 * k_pi * surface.from_axis(part, middle), spacing);
      }
    };
    if (surface.slant() > 0.0) add_rings(CapsulePart::side, 0.0, 1.0, surface.slant());
    for (const CapsulePart cap : {CapsulePart::cap_a, CapsulePart::cap_b}) {
      const double rim = surface.rim(cap);
      add_rings(cap, rim, 0.5 * k_pi, (0.5 * k_pi - rim) * surface.radius_of(cap));
    }
  }
  return cells;
}

} // namespace tutu::proxies
