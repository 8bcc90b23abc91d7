// Nothing allocates in the frame loop: by counting.
#include "proxies/query/collision_query.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/counted_allocations.h"

#include <gtest/gtest.h>

namespace {

using namespace tutu;
using test::allocations;
using namespace tutu::proxies;

TEST(Allocations, NoneInTheFrameLoopOfAnyBackend) {
  for (const Backend backend : {Backend::fcl, Backend::hybrid, Backend::brute}) {
    test::ColliderScene scene = test::dancer_scene(900);
    const auto query = make_query(backend);
    Candidates candidates, for_boxes;
    std::vector<Box> boxes;
    for (const Vec3& point : scene.points) boxes.emplace_back(point.array() - 0.05, point.array() + 0.05);
    double sum = 0.0;
    const auto frame = [&](double sway) {
      for (Vec3& point : scene.points) point.x() += sway;
      for (Capsule& capsule : scene.end) capsule.b.z() += sway;
      query->find_candidates(scene.swept(), scene.points, 0.03, candidates);
      query->find_for_boxes(scene.swept(), boxes, for_boxes);
      query->place(scene.end, scene.ground);
      for (int p = 0; p < 900; ++p)
        for (const int c : candidates.of(p)) sum += query->contact(scene.points[p], c).distance;
    };
    for (int i = 0; i < 20; ++i) frame(i % 2 ? 0.02 : -0.02);
    for (Candidates* found : {&candidates, &for_boxes})
      found->colliders.reserve(901 * (test::k_body_colliders + 1)); // more than ever needed: growth is not at issue
    const long before = allocations;
    for (int i = 0; i < 100; ++i) frame(i % 2 ? 0.01 : -0.01);
    EXPECT_EQ(allocations - before, 0) << k_backend_names[static_cast<std::size_t>(backend)];
    EXPECT_TRUE(std::isfinite(sum));
  }
}

TEST(Allocations, NoneInPosingAColliderSet) {
  Proxy proxy;
  proxy.kind = ProxyKind::capsule;
  proxy.a.count = proxy.b.count = 1;
  proxy.a.weights[0] = proxy.b.weights[0] = 1.0;
  proxy.b.points[0] = Vec3::UnitX();
  proxy.radius = 0.1;
  ColliderSet set({proxy, proxy}, Plane{});
  const std::vector<Transform> joints(1);
  std::vector<Capsule> now(2);
  const long before = allocations;
  set.reset(joints);
  set.advance(joints);
  colliders_at(set.swept(), 0.5, now);
  EXPECT_EQ(allocations - before, 0);
}

} // namespace
