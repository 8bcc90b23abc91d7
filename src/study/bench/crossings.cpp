#include "src/study/bench/crossings.h"

#include "proxies/crossing/orientation.h"
#include "proxies/crossing/segment_passages.h"
#include "proxies/crossing/segment_triangle.h"

#include <cstdlib>

namespace tutu::app {

CrossingCounter::CrossingCounter(const cloth::Garment& garment) : garment_(&garment), threads_(threads_of(garment)) {}

void CrossingCounter::place_threads(std::span<const Vec3> positions, std::vector<std::vector<Vec3>>& points) const {
  points.resize(threads_.size());
  for (std::size_t t = 0; t < threads_.size(); ++t) {
    points[t].clear();
    for (const ThreadPoint& point : threads_[t]) points[t].push_back(place_of(point, positions));
  }
}

void CrossingCounter::start(std::span<const Vec3> positions, std::span<const proxies::Capsule> capsules) {
  place_threads(positions, points_);
  capsules_.assign(capsules.begin(), capsules.end());
  crossings_ = pierced_ = pierced_now_ = 0;
}

int CrossingCounter::crossings_of(std::span<const Vec3> before, std::span<const Vec3> now,
                                  std::span<const proxies::Capsule> capsules) const {
  const auto moving = [&](std::size_t k) -> std::optional<proxies::MovingPoint> {
    const auto from = proxies::exact_place(before[k]), to = proxies::exact_place(now[k]);
    if (!from || !to) return std::nullopt;
    return proxies::MovingPoint{*from, *to};
  };
  std::vector<int> net(capsules.size());
  std::optional<proxies::MovingPoint> q = moving(0);
  for (std::size_t k = 1; k < now.size(); ++k) {
    const std::optional<proxies::MovingPoint> p = q;
    q = moving(k);
    if (!p || !q) continue;
    for (std::size_t c = 0; c < capsules.size(); ++c)
      if (capsules[c].a != capsules[c].b)
        net[c] += proxies::net_passages(*p, *q, {capsules_[c].a, capsules[c].a}, {capsules_[c].b, capsules[c].b});
  }
  int crossings = 0;
  for (const int n : net) crossings += std::abs(n);
  return crossings;
}

void CrossingCounter::advance(std::span<const Vec3> positions, std::span<const proxies::Capsule> capsules) {
  points_.swap(last_points_);
  place_threads(positions, points_);
  for (std::size_t t = 0; t < threads_.size(); ++t) crossings_ += crossings_of(last_points_[t], points_[t], capsules);
  pierced_now_ = 0;
  for (const auto& t : garment_->triangles) {
    const auto t0 = proxies::exact_place(positions[t[0]]), t1 = proxies::exact_place(positions[t[1]]),
               t2 = proxies::exact_place(positions[t[2]]);
    if (!t0 || !t1 || !t2) continue;
    for (const proxies::Capsule& capsule : capsules)
      pierced_now_ += proxies::passage_through(capsule.a, capsule.b, *t0, *t1, *t2) != 0;
  }
  pierced_ += pierced_now_;
  capsules_.assign(capsules.begin(), capsules.end());
}

} // namespace tutu::app
