#include "cloth/contact/swept_contact.h"

#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"

namespace tutu::cloth {
namespace {

/// m. Single precision keeps a particle this near to where a contact put it.
constexpr double k_touching = 1e-5;

/// Deeper at the first touch than touching is: the step began so.
bool is_inside(const proxies::Contact& touch, double offset) { return touch.distance < offset - k_touching; }

/// By how much a point that touched at `time` ends the step on the wrong side of the surface, m. Nothing for one whose
/// contact at the end still points out the way it came in: that one will do.
double passed_by(const SweptCollider& collider, double time, const proxies::Contact& touch, const Vec3& now) {
  if (proxies::signed_distance(now, collider.end).normal.dot(touch.normal) > 0.0) return 0.0;
  const proxies::Capsule then = proxies::capsule_at(collider.start, collider.end, time);
  const Vec3 surface =
      touch.closest + proxies::surface_motion(then, collider.end, (1.0 - time) * collider.spin, touch.closest);
  return collider.offset - (now - surface).dot(touch.normal);
}

/// The first touch of what began the step outside the collider. Where that was nearer than the cloth keeps, as other
/// contacts and the last step's push leave it, it is to come no nearer. Nothing for what began inside.
template <class Cloth> auto first_touch(const Cloth& from, const Cloth& to, const SweptCollider& collider) {
  auto impact = proxies::time_of_impact(from, to, collider.start, collider.end, collider.offset);
  if (!impact || !is_inside(impact->contact, collider.offset)) return impact;
  const double began = impact->contact.distance - k_touching;
  if (began < k_touching) return decltype(impact){};
  impact = proxies::time_of_impact(from, to, collider.start, collider.end, began);
  return impact && !is_inside(impact->contact, began) ? impact : decltype(impact){};
}

std::optional<SweptContact> if_passed(const SweptContact& contact) {
  return contact.passed > 0.0 ? std::optional(contact) : std::nullopt;
}

} // namespace

std::optional<SweptContact> swept_contact(const Vec3& from, const Vec3& to, const SweptCollider& collider) {
  const auto impact = first_touch(from, to, collider);
  if (!impact) return std::nullopt;
  const double passed = passed_by(collider, impact->time, impact->contact, to);
  return if_passed({impact->contact, {1.0, 0.0, 0.0}, passed, impact->time});
}

std::optional<SweptContact> swept_contact(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to,
                                          const SweptCollider& collider) {
  const auto impact = first_touch(from, to, collider);
  if (!impact || impact->contact.feature == proxies::ClothFeature::crossing) return std::nullopt;
  const std::array<double, 3>& weights = impact->contact.weights;
  const Vec3 now = weights[0] * to[0] + weights[1] * to[1] + weights[2] * to[2];
  const double passed = passed_by(collider, impact->time, impact->contact, now);
  return if_passed({impact->contact, weights, passed, impact->time});
}

} // namespace tutu::cloth
