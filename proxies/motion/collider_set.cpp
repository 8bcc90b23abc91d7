#include "proxies/motion/collider_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tutu::proxies {
namespace {

void pose(const std::vector<Proxy>& proxies, std::span<const Transform> world_from_joint, std::vector<Capsule>& out) {
  for (std::size_t i = 0; i < proxies.size(); ++i) {
    const Proxy& proxy = proxies[i];
    out[i].a = proxy.a.place(world_from_joint);
    out[i].b = proxy.kind == ProxyKind::sphere ? out[i].a : proxy.b.place(world_from_joint);
  }
}

const Quat& rotation_of(const Proxy& proxy, std::span<const Transform> world_from_joint) {
  const auto heaviest = std::max_element(proxy.a.weights.begin(), proxy.a.weights.begin() + proxy.a.count);
  return world_from_joint[proxy.a.joints[heaviest - proxy.a.weights.begin()]].rotation;
}

/// Rotation vector (world, rad, at most pi long) from one orientation to another.
Vec3 rotation_vector(const Quat& from, const Quat& to) {
  if (from.coeffs() == to.coeffs()) return Vec3::Zero(); // to the bit: the product below would leave rounding
  Quat turn = to * from.conjugate();
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm(); // of half the angle
  return sine > 0.0 ? Vec3(2.0 * std::atan2(sine, turn.w()) / sine * turn.vec()) : Vec3(Vec3::Zero());
}

} // namespace

void colliders_at(const SweptColliders& colliders, double s, std::span<Capsule> out) {
  for (std::size_t i = 0; i < colliders.start.size(); ++i) out[i] = capsule_at(colliders.start[i], colliders.end[i], s);
}

ColliderSet::ColliderSet(std::vector<Proxy> proxies, std::optional<Plane> ground)
    : proxies_(std::move(proxies)), ground_(std::move(ground)) {
  std::erase_if(proxies_, [](const Proxy& proxy) { return !proxy.enabled; });
  for (const Proxy& proxy : proxies_) start_.push_back({Vec3::Zero(), Vec3::Zero(), proxy.radius, proxy.taper});
  end_ = start_;
  rotations_.assign(proxies_.size(), Quat::Identity());
  spin_.assign(proxies_.size(), Vec3::Zero());
}

void ColliderSet::reset(std::span<const Transform> world_from_joint) {
  pose(proxies_, world_from_joint, end_);
  start_ = end_;
  for (std::size_t i = 0; i < proxies_.size(); ++i) {
    rotations_[i] = rotation_of(proxies_[i], world_from_joint);
    spin_[i].setZero();
  }
}

void ColliderSet::advance(std::span<const Transform> world_from_joint) {
  std::swap(start_, end_);
  pose(proxies_, world_from_joint, end_);
  for (std::size_t i = 0; i < proxies_.size(); ++i) {
    const Quat& rotation = rotation_of(proxies_[i], world_from_joint);
    spin_[i] = rotation_vector(rotations_[i], rotation);
    rotations_[i] = rotation;
  }
}

} // namespace tutu::proxies
