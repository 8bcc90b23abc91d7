#include "proxies/motion/sweep.h"

#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tutu::proxies {
namespace {

/// Steps of an advancement that found neither touch nor end: then what is reported is early by more than k_touch.
/// In 1e4 random cases a point takes 14 at most, an edge or a triangle 32; half of all take 3 or fewer.
constexpr int k_most_steps = 1000;

/// The longest time in which a gap cannot have closed that closes at `closing` now, if that may grow by `bend` at most
/// in a unit of time: the root of closing t + bend t^2 / 2 = gap. Infinite where it never closes.
double time_to_close(double gap, double closing, double bend) {
  const double root = std::sqrt(closing * closing + 2.0 * bend * gap);
  if (closing > 0.0) return 2.0 * gap / (closing + root);
  return bend > 0.0 ? (root - closing) / bend : std::numeric_limits<double>::infinity();
}

template <std::size_t Corners> using Cloth = std::array<Vec3, Corners>; // a point, an edge, a triangle

template <std::size_t Corners> Cloth<Corners> cloth_at(const Cloth<Corners>& from, const Cloth<Corners>& to, double t) {
  Cloth<Corners> now;
  for (std::size_t k = 0; k < Corners; ++k) now[k] = (1.0 - t) * from[k] + t * to[k];
  return now;
}

/// Conservative advancement [Mirtich 1996, Impulse-based dynamic simulation, 2.3] in the frame that turns with the
/// axis. There the axis only grows or shrinks along its direction e, and a corner of the cloth goes on a curve y(t)
/// with
///   y' = v - turn x rho,   |y''| <= 2 |turn| |v| + |turn|^2 |rho|,   rho, v: place and velocity from the middle.
/// Both are convex, the capsule as the hull of its end balls, so with the contact's normal n fixed in that frame they
/// are apart by at least the least n.y of the corners less the larger reach of a ball, +-l n.e + its radius, at every
/// time: n.y falls by y' and y'' at most, and l grows by `stretch`. Without turn that is exact for the nearest corner
/// and ball, and the way in is Newton's on a convex function. `contact_of(cloth, capsule)`: the contact at a moment.
template <std::size_t Corners, class ContactOf>
auto advance(const Cloth<Corners>& from, const Cloth<Corners>& to, const Capsule& start, const Capsule& end,
             double offset, const ContactOf& contact_of)
    -> std::optional<std::pair<double, decltype(contact_of(from, start))>> {
  const auto middle = [](const Capsule& capsule) { return Vec3(0.5 * (capsule.a + capsule.b)); };
  const AxisMotion motion = axis_motion(start, end);
  const double angle = motion.turn.norm();
  Cloth<Corners> velocities;
  std::array<double, Corners> bends; // bounds of |y''|
  for (std::size_t k = 0; k < Corners; ++k) {
    velocities[k] = to[k] - from[k] - motion.middle;
    const double farthest = std::max((from[k] - middle(start)).norm(), (to[k] - middle(end)).norm());
    bends[k] = angle * (2.0 * velocities[k].norm() + angle * farthest);
  }
  double t = 0.0;
  for (int step = 0;; ++step) {
    const Capsule now = capsule_at(start, end, t);
    const Cloth<Corners> cloth = cloth_at(from, to, t);
    const auto contact = contact_of(cloth, now);
    if (contact.distance - offset <= k_touch || step == k_most_steps) return std::pair{t, contact};
    const Vec3& n = contact.normal;
    const Vec3 half = 0.5 * (now.b - now.a);
    const double length = half.norm();
    const Vec3 growth = motion.straight + (length > 0.0 ? Vec3(motion.stretch / length * half) : Vec3(Vec3::Zero()));
    double free = std::numeric_limits<double>::infinity();
    for (const double end_of : {-1.0, 1.0}) { // a and b
      // Up to half of k_touch only: what rounding adds stays on the safe side, and each step is a real one.
      const double kept = end_of * n.dot(half) + now.radius_at(0.5 + 0.5 * end_of) + offset + 0.5 * k_touch;
      for (std::size_t k = 0; k < Corners; ++k) {
        const Vec3 place = cloth[k] - middle(now);
        const double closing = end_of * n.dot(growth) - n.dot(velocities[k] - motion.turn.cross(place));
        free = std::min(free, time_to_close(n.dot(place) - kept, closing, bends[k]));
      }
    }
    t += free;
    if (!(t <= 1.0)) return std::nullopt;
  }
}

} // namespace

std::optional<Impact> time_of_impact(const Vec3& from, const Vec3& to, const Capsule& start, const Capsule& end,
                                     double offset) {
  const auto contact_of = [](const Cloth<1>& p, const Capsule& capsule) { return signed_distance(p[0], capsule); };
  const auto touch = advance(Cloth<1>{from}, Cloth<1>{to}, start, end, offset, contact_of);
  if (!touch) return std::nullopt;
  return Impact{touch->first, touch->second};
}

std::optional<FeatureImpact> time_of_impact(const std::array<Vec3, 2>& from, const std::array<Vec3, 2>& to,
                                            const Capsule& start, const Capsule& end, double offset) {
  const auto contact_of = [](const Cloth<2>& p, const Capsule& capsule) {
    return edge_contact(p[0], p[1], capsule, Vec3::Zero());
  };
  const auto touch = advance(from, to, start, end, offset, contact_of);
  if (!touch) return std::nullopt;
  return FeatureImpact{touch->first, touch->second};
}

std::optional<FeatureImpact> time_of_impact(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to,
                                            const Capsule& start, const Capsule& end, double offset) {
  const auto contact_of = [](const Cloth<3>& p, const Capsule& capsule) {
    return triangle_contact(p[0], p[1], p[2], capsule, Vec3::Zero());
  };
  const auto touch = advance(from, to, start, end, offset, contact_of);
  if (!touch) return std::nullopt;
  return FeatureImpact{touch->first, touch->second};
}

double safe_motion(double radius, double offset) { return radius + offset; }

} // namespace tutu::proxies
