#include "proxies/collision_query.h"

#include "proxies/broad_phase.h"
#include "proxies/narrow_phase.h"
#include "proxies/query_guard.h"
#include "proxies/signed_distance.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace tutu::proxies {
namespace {

/// Boxes and reach are grown by this (m), so that rounding never costs a pair that is exactly `reach` away.
constexpr double k_slack = 1e-9;

void require_usable_frame(const SweptColliders& colliders, std::span<const Vec3> points, double reach) {
  if (colliders.start.size() != colliders.end.size())
    throw std::invalid_argument("collision query: found " + std::to_string(colliders.start.size()) +
                                " colliders at the start of the frame and " + std::to_string(colliders.end.size()) +
                                " at its end, expected as many");
  for (int i = 0; i < colliders.size(); ++i) {
    require_usable(colliders.start[i], i);
    require_usable(colliders.end[i], i);
  }
  require_usable(colliders.ground);
  require_usable(points, reach);
}

void require_usable_place(std::span<const Capsule> colliders, const std::optional<Plane>& ground) {
  for (std::size_t i = 0; i < colliders.size(); ++i) require_usable(colliders[i], static_cast<int>(i));
  require_usable(ground);
}

class BruteQuery final : public CollisionQuery {
public:
  std::string_view name() const override { return "brute"; }

  void find_candidates(const SweptColliders& colliders, std::span<const Vec3> points, double reach,
                       Candidates& out) override {
    require_usable_frame(colliders, points, reach);
    const int each = colliders.size() + (colliders.ground ? 1 : 0);
    out.begin.assign(1, 0);
    out.colliders.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int collider = 0; collider < each; ++collider) out.colliders.push_back(collider);
      out.begin.push_back(static_cast<int>(out.colliders.size()));
    }
  }

  void place(std::span<const Capsule> colliders, const std::optional<Plane>& ground) override {
    require_usable_place(colliders, ground);
    colliders_.assign(colliders.begin(), colliders.end());
    ground_ = ground;
  }

  Contact contact(const Vec3& point, int collider) const override {
    require_usable(point);
    return collider == static_cast<int>(colliders_.size()) ? signed_distance(point, *ground_)
                                                           : signed_distance(point, colliders_[collider]);
  }

private:
  std::vector<Capsule> colliders_;
  std::optional<Plane> ground_;
};

class FclQuery final : public CollisionQuery {
public:
  std::string_view name() const override { return "fcl"; }

  void find_candidates(const SweptColliders& colliders, std::span<const Vec3> points, double reach,
                       Candidates& out) override {
    require_usable_frame(colliders, points, reach);
    broad_phase_.update(colliders.start, colliders.end);
    cover(colliders);
    const double grown = reach + k_slack;
    out.begin.assign(1, 0);
    out.colliders.clear();
    for (const Vec3& point : points) {
      const auto row = static_cast<std::ptrdiff_t>(out.colliders.size());
      broad_phase_.overlaps({point.array() - grown, point.array() + grown}, out.colliders);
      const auto is_far = [&](int i) { return signed_distance(point, covers_[i]).distance > grown; };
      out.colliders.erase(std::remove_if(out.colliders.begin() + row, out.colliders.end(), is_far),
                          out.colliders.end());
      std::sort(out.colliders.begin() + row, out.colliders.end());
      if (colliders.ground) out.colliders.push_back(colliders.ground_index());
      out.begin.push_back(static_cast<int>(out.colliders.size()));
    }
  }

  void place(std::span<const Capsule> colliders, const std::optional<Plane>& ground) override {
    require_usable_place(colliders, ground);
    narrow_phase_.place(colliders);
    count_ = static_cast<int>(colliders.size());
    ground_ = ground;
  }

  Contact contact(const Vec3& point, int collider) const override {
    require_usable(point);
    return collider == count_ ? signed_distance(point, *ground_) : narrow_phase_.contact(point, collider);
  }

private:
  /// One still capsule around each moving one: about the middle pose, wider by half the longer way an end goes. Each
  /// end, and so each point of the axis, stays within that of its middle place.
  void cover(const SweptColliders& colliders) {
    covers_.resize(colliders.start.size());
    for (std::size_t i = 0; i < covers_.size(); ++i) {
      const Capsule &start = colliders.start[i], &end = colliders.end[i];
      const double way = std::max((end.a - start.a).norm(), (end.b - start.b).norm());
      covers_[i] = {0.5 * (start.a + end.a), 0.5 * (start.b + end.b), std::max(start.radius, end.radius) + 0.5 * way};
    }
  }

  BroadPhase broad_phase_;
  NarrowPhase narrow_phase_;
  std::vector<Capsule> covers_;
  std::optional<Plane> ground_;
  int count_ = 0;
};

} // namespace

Backend backend_named(std::string_view name) {
  const auto found = std::find(k_backend_names.begin(), k_backend_names.end(), name);
  if (found == k_backend_names.end()) throw std::invalid_argument("no backend called " + std::string(name));
  return static_cast<Backend>(found - k_backend_names.begin());
}

std::unique_ptr<CollisionQuery> make_query(Backend backend) {
  if (backend == Backend::brute) return std::make_unique<BruteQuery>();
  return std::make_unique<FclQuery>();
}

} // namespace tutu::proxies
