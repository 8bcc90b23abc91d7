#include "proxies/collider_set.h"

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

/// Exact at both ends, and a point that does not move stays where it is to the bit.
Vec3 on_the_way(const Vec3& start, const Vec3& end, double s) {
  return {std::lerp(start.x(), end.x(), s), std::lerp(start.y(), end.y(), s), std::lerp(start.z(), end.z(), s)};
}

} // namespace

void colliders_at(const SweptColliders& colliders, double s, std::span<Capsule> out) {
  for (std::size_t i = 0; i < colliders.start.size(); ++i) {
    const Capsule &start = colliders.start[i], &end = colliders.end[i];
    out[i] = {on_the_way(start.a, end.a, s), on_the_way(start.b, end.b, s), start.radius};
  }
}

ColliderSet::ColliderSet(std::vector<Proxy> proxies, std::optional<Plane> ground)
    : proxies_(std::move(proxies)), ground_(std::move(ground)) {
  std::erase_if(proxies_, [](const Proxy& proxy) { return !proxy.enabled; });
  for (const Proxy& proxy : proxies_) start_.push_back({Vec3::Zero(), Vec3::Zero(), proxy.radius});
  end_ = start_;
}

void ColliderSet::reset(std::span<const Transform> world_from_joint) {
  pose(proxies_, world_from_joint, end_);
  start_ = end_;
}

void ColliderSet::advance(std::span<const Transform> world_from_joint) {
  std::swap(start_, end_);
  pose(proxies_, world_from_joint, end_);
}

} // namespace tutu::proxies
