#include "proxies/motion/collider_motion.h"

#include "proxies/distance/signed_distance.h"

#include <algorithm>
#include <cmath>

namespace tutu::proxies {
namespace {

/// Axes that differ by less than this (rad, as the distance of their unit vectors) go on straight lines: the arc bulges
/// by 1e-17 of a length, below the last bit.
constexpr double k_least_turn = 1e-8;
/// Axes this near to opposite (rad) have no shorter arc that rounding would not decide.
constexpr double k_half_turn = 1e-6;

/// An axis with its middle as origin.
struct HalfAxis {
  Vec3 direction; // unit; meaningless where length is not above k_on_axis
  double length;  // half of the capsule's, m
};

HalfAxis half_axis(const Capsule& capsule) {
  const Vec3 half = 0.5 * (capsule.b - capsule.a);
  const double length = half.norm();
  return {length > k_on_axis ? Vec3(1.0 / length * half) : Vec3(Vec3::Zero()), length};
}

bool goes_on_an_arc(const HalfAxis& start, const HalfAxis& end) {
  if (start.length <= k_on_axis || end.length <= k_on_axis) return false;
  return (end.direction - start.direction).squaredNorm() > k_least_turn * k_least_turn &&
         (end.direction + start.direction).squaredNorm() > k_half_turn * k_half_turn;
}

/// Exact at both ends, and a point that does not move stays where it is to the bit.
Vec3 on_the_way(const Vec3& start, const Vec3& end, double s) {
  return {std::lerp(start.x(), end.x(), s), std::lerp(start.y(), end.y(), s), std::lerp(start.z(), end.z(), s)};
}

/// sin(s angle) / sin(angle) for 1 - cos(angle) = versine <= k_versine, as its power series in the versine [Eberly
/// 2011, A fast and accurate algorithm for computing SLERP]; the first term left out is below 1e-17. Unlike the
/// library's sine it has the same bits on every machine.
constexpr double k_versine = 0.02; // 0.2 rad
double sine_ratio(double s, double versine) {
  double sum = 1.0;
  for (int i = 7; i >= 1; --i) {
    const double share = 1.0 / (i * (2 * i + 1)); // a constant once unrolled, unlike a quotient with the versine
    sum = 1.0 + versine * share * (i * i - s * s) * sum;
  }
  return s * sum;
}

/// Slerp of unit vectors that are not opposite. Longer arcs are halved until the series serves.
Vec3 turned(Vec3 start, Vec3 end, double s) {
  for (;;) {
    const double versine = 0.5 * (end - start).squaredNorm();
    if (versine <= k_versine) return sine_ratio(1.0 - s, versine) * start + sine_ratio(s, versine) * end;
    const Vec3 middle = (start + end).normalized();
    (s < 0.5 ? end : start) = middle;
    s = s < 0.5 ? 2.0 * s : 2.0 * s - 1.0;
  }
}

/// How far an end of the moving capsule may be from where it would be on its straight line, m.
/// With h(s) = l(s) d(s), the half axis, that is |h(s) - ((1-s) h(0) + s h(1))| <= max |h''| / 8 (the error of linear
/// interpolation), and |h''| <= 2 |l'| angle + l angle^2, since l is linear and d turns evenly. The angle is bounded
/// through the chord c = |d(1) - d(0)| = 2 sin(angle / 2): asin(x)^2 <= x^2 (1 + (pi^2/4 - 1) x^2) on [0, 1], all
/// coefficients of its series being positive.
double bulge(const Capsule& start, const Capsule& end) {
  const HalfAxis from = half_axis(start), to = half_axis(end);
  if (!goes_on_an_arc(from, to)) return 0.0;
  constexpr double k_asin_square = 0.3668503; // (pi^2/4 - 1) / 4, rounded up
  const double chord_squared = (to.direction - from.direction).squaredNorm();
  const double angle_squared = chord_squared * (1.0 + k_asin_square * chord_squared);
  const double longer = std::max(from.length, to.length), change = std::abs(to.length - from.length);
  return 0.125 * (2.0 * change * std::sqrt(angle_squared) + longer * angle_squared);
}

} // namespace

Capsule capsule_at(const Capsule& start, const Capsule& end, double s) {
  if (s == 0.0) return start;
  if (s == 1.0) return end;
  const HalfAxis from = half_axis(start), to = half_axis(end);
  if (!goes_on_an_arc(from, to))
    return {on_the_way(start.a, end.a, s), on_the_way(start.b, end.b, s), start.radius, start.taper};
  const Vec3 middle = (0.5 - 0.5 * s) * (start.a + start.b) + (0.5 * s) * (end.a + end.b);
  const Vec3 half = ((1.0 - s) * from.length + s * to.length) * turned(from.direction, to.direction, s);
  return {middle - half, middle + half, start.radius, start.taper};
}

AxisMotion axis_motion(const Capsule& start, const Capsule& end) {
  const Vec3 middle = 0.5 * (end.a - start.a + end.b - start.b);
  const HalfAxis from = half_axis(start), to = half_axis(end);
  if (!goes_on_an_arc(from, to)) return {middle, 0.5 * (end.b - end.a) - 0.5 * (start.b - start.a), Vec3::Zero(), 0.0};
  const Vec3 cross = from.direction.cross(to.direction);
  const double sine = cross.norm(); // not 0: the arc is neither none nor half a turn
  const double angle = std::atan2(sine, from.direction.dot(to.direction));
  return {middle, Vec3::Zero(), angle / sine * cross, to.length - from.length};
}

double farthest_way(const Capsule& start, const Capsule& end) {
  return std::max((end.a - start.a).norm(), (end.b - start.b).norm());
}

Box swept_box(const Capsule& start, const Capsule& end) {
  const double bulges = bulge(start, end);
  Box box;
  for (const Capsule* pose : {&start, &end})
    for (const double t : {0.0, 1.0}) {
      const Vec3 centre = t == 0.0 ? pose->a : pose->b, grown = Vec3::Constant(pose->radius_at(t) + bulges);
      box.extend(Box(centre - grown, centre + grown));
    }
  return box;
}

Capsule swept_cover(const Capsule& start, const Capsule& end) {
  return {0.5 * (start.a + end.a), 0.5 * (start.b + end.b),
          start.radius + 0.5 * farthest_way(start, end) + bulge(start, end), start.taper};
}

Vec3 surface_motion(const Capsule& before, const Capsule& now, const Vec3& spin_since_before, const Vec3& point) {
  const double t = nearest_on_axis(point, now), radius = now.radius_at(t);
  const Vec3 away = point - (now.a + t * (now.b - now.a));
  const double distance = away.norm();
  const Vec3 arm = distance > k_on_axis ? Vec3(radius / distance * away) : Vec3(radius * normal_on_axis(now));
  Vec3 turn = spin_since_before; // a sphere has nothing else to tell by
  const HalfAxis was = half_axis(before), is = half_axis(now);
  if (is.length > k_on_axis) {
    // Spin about the direction halfway: about either end's, a term of second order would stay.
    const Vec3 axle = (was.direction + is.direction).normalized();
    turn = was.direction.cross(is.direction) + axle.dot(spin_since_before) * axle;
  }
  return (1.0 - t) * (now.a - before.a) + t * (now.b - before.b) + turn.cross(arm);
}

} // namespace tutu::proxies
