#include "proxies/fit/detail/guard.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::proxies::fit {
namespace {

constexpr int k_guard_points = 8000; // of the skin, a pose
constexpr double k_cell = 0.0125;    // of the height
constexpr float k_margin = 5.0f;     // cells around the body

/// A surface point of a capsule: where along the axis, and the direction from it in the axis' own frame (along, and
/// two across).
struct SurfacePoint {
  double t;
  Vec3 direction;
  bool cap;
};

std::vector<SurfacePoint> surface_points() {
  std::vector<SurfacePoint> points;
  for (const double t : {0.0, 0.5, 1.0})
    for (int k = 0; k < 8; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + (t == 0.5 ? 0.5 : 0.0)) / 8.0;
      points.push_back({t, {0.0, std::cos(angle), std::sin(angle)}, false});
    }
  for (const double t : {0.0, 1.0}) {
    const double outwards = t == 0.0 ? -1.0 : 1.0;
    points.push_back({t, {outwards, 0.0, 0.0}, true});
    for (int k = 0; k < 6; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 6.0, s = std::sqrt(0.5);
      points.push_back({t, {outwards * s, s * std::cos(angle), s * std::sin(angle)}, true});
    }
  }
  return points;
}

void sweep(std::vector<int>& nearest, std::vector<float>& squared, const std::array<int, 3>& n, const Vec3f& origin,
           float cell, const std::vector<Vec3f>& points, int step) {
  const auto at = [&](int i, int j, int k) { return (static_cast<std::size_t>(k) * n[1] + j) * n[0] + i; };
  const auto from = [&](int size) { return step > 0 ? 0 : size - 1; };
  const auto inside = [](int i, int size) { return i >= 0 && i < size; };
  for (int k = from(n[2]); inside(k, n[2]); k += step)
    for (int j = from(n[1]); inside(j, n[1]); j += step)
      for (int i = from(n[0]); inside(i, n[0]); i += step) {
        const std::size_t here = at(i, j, k);
        const Vec3f place = origin + cell * Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
        const auto ask = [&](int x, int y, int z) {
          if (!inside(x, n[0]) || !inside(y, n[1]) || !inside(z, n[2])) return;
          const int point = nearest[at(x, y, z)];
          if (point < 0 || point == nearest[here]) return;
          const float d = (points[point] - place).squaredNorm();
          if (d < squared[here]) squared[here] = d, nearest[here] = point;
        };
        ask(i - step, j, k);
        ask(i, j - step, k);
        ask(i, j, k - step);
        ask(i + step, j - step, k);
        ask(i + step, j, k - step);
        ask(i, j + step, k - step);
      }
}

} // namespace

DistanceGrid::DistanceGrid(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals, float cell,
                           float spacing)
    : cell_(cell) {
  Vec3f low = positions[0], high = positions[0];
  for (const Vec3f& p : positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  origin_ = low - Vec3f::Constant(k_margin * cell);
  for (int axis = 0; axis < 3; ++axis)
    size_[axis] = static_cast<int>(std::ceil((high[axis] - low[axis]) / cell + 2.0f * k_margin)) + 1;
  const std::size_t nodes = static_cast<std::size_t>(size_[0]) * size_[1] * size_[2];
  std::vector<int> nearest(nodes, -1);
  std::vector<float> squared(nodes, std::numeric_limits<float>::infinity());
  const auto at = [&](int i, int j, int k) { return (static_cast<std::size_t>(k) * size_[1] + j) * size_[0] + i; };
  for (int p = 0; p < static_cast<int>(positions.size()); ++p) {
    const Vec3f local = (positions[p] - origin_) / cell;
    const int i0 = static_cast<int>(local.x()), j0 = static_cast<int>(local.y()), k0 = static_cast<int>(local.z());
    for (int corner = 0; corner < 8; ++corner) {
      const int i = i0 + (corner & 1), j = j0 + ((corner >> 1) & 1), k = k0 + (corner >> 2);
      const float d =
          (local - Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k))).squaredNorm() * cell *
          cell;
      if (d < squared[at(i, j, k)]) squared[at(i, j, k)] = d, nearest[at(i, j, k)] = p;
    }
  }
  for (int round = 0; round < 2; ++round)
    for (const int step : {1, -1}) sweep(nearest, squared, size_, origin_, cell, positions, step);
  value_.resize(nodes);
  for (int k = 0; k < size_[2]; ++k)
    for (int j = 0; j < size_[1]; ++j)
      for (int i = 0; i < size_[0]; ++i) {
        const std::size_t node = at(i, j, k);
        const Vec3f place = origin_ + cell * Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
        const Vec3f away = place - positions[nearest[node]];
        // The point stands for a disc of half the spacing.
        const float up = away.dot(normals[nearest[node]]);
        const float flat = std::max(0.0f, std::sqrt(std::max(0.0f, away.squaredNorm() - up * up)) - 0.5f * spacing);
        value_[node] = std::copysign(std::hypot(up, flat), up);
      }
}

double DistanceGrid::at(const Vec3& point, Vec3& gradient) const {
  Vec3 local = (point - origin_.cast<double>()) / static_cast<double>(cell_);
  Vec3 clamped;
  for (int axis = 0; axis < 3; ++axis) clamped[axis] = std::clamp(local[axis], 0.0, size_[axis] - 1.001);
  const Vec3 beyond = (local - clamped) * static_cast<double>(cell_);
  const int i = static_cast<int>(clamped.x()), j = static_cast<int>(clamped.y()), k = static_cast<int>(clamped.z());
  const double u = clamped.x() - i, v = clamped.y() - j, w = clamped.z() - k;
  const auto node = [&](int a, int b, int c) {
    return static_cast<double>(value_[(static_cast<std::size_t>(k + c) * size_[1] + (j + b)) * size_[0] + (i + a)]);
  };
  const double c000 = node(0, 0, 0), c100 = node(1, 0, 0), c010 = node(0, 1, 0), c110 = node(1, 1, 0);
  const double c001 = node(0, 0, 1), c101 = node(1, 0, 1), c011 = node(0, 1, 1), c111 = node(1, 1, 1);
  const auto mix = [](double a, double b, double s) { return a + s * (b - a); };
  const double x00 = mix(c000, c100, u), x10 = mix(c010, c110, u), x01 = mix(c001, c101, u), x11 = mix(c011, c111, u);
  const double y0 = mix(x00, x10, v), y1 = mix(x01, x11, v);
  gradient.x() = mix(mix(c100 - c000, c110 - c010, v), mix(c101 - c001, c111 - c011, v), w);
  gradient.y() = mix(x10 - x00, x11 - x01, w);
  gradient.z() = y1 - y0;
  gradient /= static_cast<double>(cell_);
  const double out = beyond.norm();
  if (out > 0.0) gradient = beyond / out;
  return mix(y0, y1, w) + out;
}

Guard::Guard(const rig::Character& character, const std::vector<std::vector<Transform>>& all, std::vector<int> poses,
             const BodyMotion& motion)
    : poses_(std::move(poses)) {
  std::vector<std::vector<Transform>> chosen;
  for (const int p : poses_) chosen.push_back(all[p]);
  const SkinCloud cloud = skin_cloud(character, chosen, k_guard_points);
  const auto spacing = static_cast<float>(std::sqrt(motion.area / k_guard_points));
  for (std::size_t g = 0; g < poses_.size(); ++g)
    grids_.emplace_back(cloud.positions[g], cloud.normals[g], static_cast<float>(k_cell * motion.height), spacing);
}

double Guard::cost(const Unit& unit, const BodyMotion& motion, const Strength& strength, Hessian* hessian,
                   Row* gradient) const {
  static const std::vector<SurfacePoint> points = surface_points();
  double total = 0.0;
  for (std::size_t g = 0; g < poses_.size(); ++g) {
    const Affine &fa = unit.frames_a[poses_[g]], &fb = unit.frames_b[poses_[g]];
    const Vec3 a = fa.leftCols<3>() * unit.a + fa.col(3), b = fb.leftCols<3>() * unit.b + fb.col(3);
    const double length = (b - a).norm();
    const Vec3 along = length > 1e-9 ? Vec3((b - a) / length) : Vec3::UnitY();
    int least = 0;
    along.cwiseAbs().minCoeff(&least);
    const Vec3 across = along.cross(Vec3::Unit(least)).normalized(), third = along.cross(across);
    // Of a cone: its mean girth, and normals that lean as its side does.
    const double ra = unit.radius_a, rb = unit.radius_b,
                 sine = std::clamp((rb - ra) / std::max(length, 1e-9), -1.0, 1.0),
                 cosine = std::sqrt(1.0 - sine * sine);
    const double side = std::numbers::pi * (ra + rb) * cosine * cosine * length,
                 caps = 2.0 * std::numbers::pi * (ra * ra + rb * rb);
    for (const SurfacePoint& point : points) {
      const double lean = point.cap ? 1.0 : cosine, forth = point.cap ? point.direction.x() : -sine;
      const Vec3 direction = forth * along + lean * (point.direction.y() * across + point.direction.z() * third);
      const Vec3 q = a + point.t * (b - a) + (ra + point.t * (rb - ra)) * direction;
      Vec3 slope;
      const double out = grids_[g].at(q, slope) - strength.dead;
      if (!(out > 0.0)) continue;
      const double patch = point.cap ? caps / 14.0 : side / 24.0;
      const double weight =
          unit.shapes() * strength.weight * patch / (motion.area * static_cast<double>(poses_.size()));
      total += weight * out * out;
      if (!hessian) continue;
      Row row;
      row << (1.0 - point.t) * (fa.leftCols<3>().transpose() * slope), point.t * (fb.leftCols<3>().transpose() * slope),
          (1.0 - point.t) * slope.dot(direction), point.t * slope.dot(direction);
      constrain(row, unit);
      *hessian += weight * row * row.transpose();
      *gradient += weight * out * row;
    }
  }
  return total;
}

} // namespace tutu::proxies::fit
