#include "proxies/crossing/orientation.h"

#include "proxies/crossing/detail/exact_sum.h"

#include <cmath>

namespace tutu::proxies {
namespace {

constexpr double k_epsilon = 0x1p-53; ///< half the distance from 1 to the next double
constexpr double k_volume_error = (7.0 + 56.0 * k_epsilon) * k_epsilon;
constexpr double k_area_error = (3.0 + 16.0 * k_epsilon) * k_epsilon; // [Shewchuk 1997, 4.2]

struct ExactVector {
  ExactDifference x, y, z;
};

ExactVector exact_vector(const Vec3& from, const Vec3& to) {
  return {exact_difference(to.x(), from.x()), exact_difference(to.y(), from.y()), exact_difference(to.z(), from.z())};
}

void add_product(ExactSum& sum, double sign, const ExactDifference& a, const ExactDifference& b) {
  for (const double u : {a.head, a.tail})
    for (const double v : {b.head, b.tail}) sum.add_product(sign * u, v);
}

void add_product(ExactSum& sum, double sign, const ExactDifference& a, const ExactDifference& b,
                 const ExactDifference& c) {
  for (const double u : {a.head, a.tail})
    for (const double v : {b.head, b.tail})
      for (const double w : {c.head, c.tail})
        if (u != 0.0 && v != 0.0 && w != 0.0) sum.add_product(sign * u, v, w);
}

int exact_volume_sign(const ExactVector& u, const ExactVector& v, const ExactVector& w) {
  ExactSum sum;
  add_product(sum, 1.0, u.x, v.y, w.z);
  add_product(sum, 1.0, u.y, v.z, w.x);
  add_product(sum, 1.0, u.z, v.x, w.y);
  add_product(sum, -1.0, u.x, v.z, w.y);
  add_product(sum, -1.0, u.y, v.x, w.z);
  add_product(sum, -1.0, u.z, v.y, w.x);
  return sum.sign();
}

} // namespace

std::optional<Vec3> exact_place(const Vec3& point) {
  if (!(point.cwiseAbs().maxCoeff() <= k_largest_exact) || !point.allFinite()) return std::nullopt;
  return point.unaryExpr([](double x) { return std::abs(x) < k_least_exact ? 0.0 : x; });
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return volume_sign(a, b, a, c, a, d); }

int volume_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e, const Vec3& f) {
  const Vec3 u = b - a, v = d - c, w = f - e;
  const double vxwy = v.x() * w.y(), wxvy = w.x() * v.y();
  const double wxuy = w.x() * u.y(), uxwy = u.x() * w.y();
  const double uxvy = u.x() * v.y(), vxuy = v.x() * u.y();
  const double volume = u.z() * (vxwy - wxvy) + v.z() * (wxuy - uxwy) + w.z() * (uxvy - vxuy);
  const double size = (std::abs(vxwy) + std::abs(wxvy)) * std::abs(u.z()) +
                      (std::abs(wxuy) + std::abs(uxwy)) * std::abs(v.z()) +
                      (std::abs(uxvy) + std::abs(vxuy)) * std::abs(w.z());
  const double error = k_volume_error * size;
  if (volume > error) return 1;
  if (volume < -error) return -1;
  return exact_volume_sign(exact_vector(a, b), exact_vector(c, d), exact_vector(e, f));
}

int cross_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int axis) {
  const int y = (axis + 1) % 3, z = (axis + 2) % 3;
  const double one = (b[y] - a[y]) * (d[z] - c[z]), other = (b[z] - a[z]) * (d[y] - c[y]);
  const double error = k_area_error * (std::abs(one) + std::abs(other));
  if (one - other > error) return 1;
  if (one - other < -error) return -1;
  ExactSum sum;
  add_product(sum, 1.0, exact_difference(b[y], a[y]), exact_difference(d[z], c[z]));
  add_product(sum, -1.0, exact_difference(b[z], a[z]), exact_difference(d[y], c[y]));
  return sum.sign();
}

} // namespace tutu::proxies
