#include "src/study/bench/crossings.h"

#include "proxies/crossing/capsule_surface.h"
#include "proxies/crossing/orientation.h"
#include "proxies/crossing/segment_triangle.h"
#include "proxies/crossing/surface_crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace tutu::app {
namespace {

/// m, how far beside its place the axis is watched: an axis that meets a particle exactly would pass through both edges
/// there, or by rounding through neither. Far above rounding, far below what cloth does; in no direction of note.
const Vec3 k_beside(1e-9, 0.618e-9, 0.382e-9);

double triple(const Vec3& u, const Vec3& v, const Vec3& w) { return u.dot(v.cross(w)); }

/// c[0] + c[1] t + c[2] t^2 + c[3] t^3.
struct Cubic {
  std::array<double, 4> c = {};
  double at(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
};

/// Six times the volume of the tetrahedron p q a b over time: 0 where the four are in one plane.
Cubic volume_of(const MovingPoint& p, const MovingPoint& q, const MovingPoint& a, const MovingPoint& b) {
  const Vec3 u = q.from - p.from, v = a.from - p.from, w = b.from - p.from;
  const Vec3 du = q.to - p.to - u, dv = a.to - p.to - v, dw = b.to - p.to - w;
  return {{triple(u, v, w), triple(du, v, w) + triple(u, dv, w) + triple(u, v, dw),
           triple(u, dv, dw) + triple(du, v, dw) + triple(du, dv, w), triple(du, dv, dw)}};
}

/// The times in [0, 1] between which the cubic is monotonic, ends included.
std::vector<double> monotonic_parts(const Cubic& f) {
  std::vector<double> times = {0.0};
  const double a = 3.0 * f.c[3], b = 2.0 * f.c[2], c = f.c[1]; // derivative a t^2 + b t + c
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant >= 0.0) {
    // The form that loses no digits where b is large.
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    for (const double t : {a != 0.0 ? q / a : -1.0, q != 0.0 ? c / q : -1.0})
      if (t > 0.0 && t < 1.0) times.push_back(t);
  }
  times.push_back(1.0);
  std::sort(times.begin(), times.end());
  return times;
}

double root_between(const Cubic& f, double low, double high) {
  const bool rising = f.at(low) <= 0.0;
  constexpr int k_halvings = 60; // to the last bit of a double in [0, 1]
  for (int k = 0; k < k_halvings; ++k) {
    const double middle = 0.5 * (low + high);
    ((f.at(middle) <= 0.0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Vec3 at(const MovingPoint& point, double t) { return point.from + t * (point.to - point.from); }

/// Of four points in one plane: whether the segments p q and a b meet.
bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  const Vec3 d = q - p, e = b - a, r = a - p;
  const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e);
  const double denominator = dd * ee - de * de;
  if (!(denominator > 0.0)) return false; // parallel: side by side or on one line, and no passage either way
  const double s = (r.dot(d) * ee - r.dot(e) * de) / denominator;
  const double t = (r.dot(d) * de - r.dot(e) * dd) / denominator;
  return s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0;
}

/// Whether the boxes around both motions are apart.
bool apart(const MovingPoint& p, const MovingPoint& q, const MovingPoint& a, const MovingPoint& b) {
  const Vec3 low = p.from.cwiseMin(p.to).cwiseMin(q.from).cwiseMin(q.to);
  const Vec3 high = p.from.cwiseMax(p.to).cwiseMax(q.from).cwiseMax(q.to);
  const Vec3 other_low = a.from.cwiseMin(a.to).cwiseMin(b.from).cwiseMin(b.to);
  const Vec3 other_high = a.from.cwiseMax(a.to).cwiseMax(b.from).cwiseMax(b.to);
  return (low.array() > other_high.array()).any() || (high.array() < other_low.array()).any();
}

/// The cloth a nanometre a metre towards its rest shape, that turned askew: layers that lie exactly on each other part
/// as they do at rest, and of folds along threads no edge meets another exactly. What is sewn stays together.
std::vector<Vec3> parted_layers(const cloth::Garment& garment, std::span<const Vec3> positions) {
  constexpr double k_part = 1e-9;
  const Eigen::Matrix3d askew{{1.0, 0.382, -0.236}, {-0.382, 1.0, 0.618}, {0.236, -0.618, 1.0}};
  std::vector<Vec3> parted;
  for (std::size_t i = 0; i < positions.size(); ++i)
    parted.push_back(positions[i] + k_part * (askew * garment.rest_positions[i]));
  return parted;
}

} // namespace

int net_passages(const MovingPoint& p, const MovingPoint& q, const MovingPoint& a, const MovingPoint& b) {
  if (apart(p, q, a, b)) return 0;
  const Cubic volume = volume_of(p, q, a, b);
  const std::vector<double> times = monotonic_parts(volume);
  int net = 0;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const double before = volume.at(times[k]), after = volume.at(times[k + 1]);
    if ((before <= 0.0) == (after <= 0.0)) continue;
    const double t = root_between(volume, times[k], times[k + 1]);
    if (segments_meet(at(p, t), at(q, t), at(a, t), at(b, t))) net += before <= 0.0 ? 1 : -1;
  }
  return net;
}

CrossingCounter::CrossingCounter(const cloth::Garment& garment) : garment_(&garment), threads_(threads_of(garment)) {}

void CrossingCounter::start(std::span<const Vec3> positions, std::span<const proxies::Capsule> capsules) {
  positions_.assign(positions.begin(), positions.end());
  capsules_.assign(capsules.begin(), capsules.end());
  crossings_ = pierced_ = pierced_now_ = 0;
}

int CrossingCounter::crossings_of(const Thread& thread, std::span<const Vec3> positions,
                                  std::span<const proxies::Capsule> capsules) const {
  int crossings = 0;
  for (std::size_t c = 0; c < capsules.size(); ++c) {
    if (capsules[c].a == capsules[c].b) continue;
    const MovingPoint a{capsules_[c].a + k_beside, capsules[c].a + k_beside},
        b{capsules_[c].b + k_beside, capsules[c].b + k_beside};
    int net = 0;
    MovingPoint q = {place_of(thread[0], positions_), place_of(thread[0], positions)};
    for (std::size_t k = 1; k < thread.size(); ++k) {
      const MovingPoint p = q;
      q = {place_of(thread[k], positions_), place_of(thread[k], positions)};
      net += net_passages(p, q, a, b);
    }
    crossings += std::abs(net);
  }
  return crossings;
}

void CrossingCounter::advance(std::span<const Vec3> positions, std::span<const proxies::Capsule> capsules) {
  for (const Thread& thread : threads_) crossings_ += crossings_of(thread, positions, capsules);
  pierced_now_ = 0;
  for (const auto& t : garment_->triangles) {
    const auto t0 = proxies::exact_place(positions[t[0]]), t1 = proxies::exact_place(positions[t[1]]),
               t2 = proxies::exact_place(positions[t[2]]);
    if (!t0 || !t1 || !t2) continue;
    for (const proxies::Capsule& capsule : capsules)
      pierced_now_ += proxies::passage_through(capsule.a, capsule.b, *t0, *t1, *t2) != 0;
  }
  pierced_ += pierced_now_;
  positions_.assign(positions.begin(), positions.end());
  capsules_.assign(capsules.begin(), capsules.end());
}

SurfacesThrough surfaces_through(const cloth::Garment& garment, std::span<const Vec3> positions,
                                 std::span<const proxies::Capsule> capsules) {
  constexpr int k_around = 48; // 0.3 mm within a limb of 60 mm
  const proxies::SurfaceView cloth{positions, garment.triangles};
  const std::vector<Vec3> parted = parted_layers(garment, positions);
  SurfacesThrough found;
  for (const proxies::Capsule& capsule : capsules) {
    const proxies::CapsuleTriangles solid = proxies::capsule_surface(capsule, k_around);
    found.colliders += proxies::crossings_between(cloth, {solid.positions, solid.triangles}).crossings;
  }
  std::vector<std::pair<int, int>> sewn;
  for (const cloth::Seam& seam : garment.seams) sewn.emplace_back(seam.i, seam.j);
  found.cloth = proxies::crossings_within({parted, garment.triangles}, sewn).crossings;
  return found;
}

} // namespace tutu::app
