// One query asked from several threads at once.
#include "proxies/query/collision_query.h"
#include "tests/support/collider_scenes.h"

#include <gmock/gmock.h>
#include <thread>

using namespace tutu;
using namespace tutu::proxies;
using namespace tutu::test;

namespace {

TEST(CollisionQuery, ContactMayBeAskedFromSeveralThreads) {
  for (const Backend backend : {Backend::fcl, Backend::hybrid}) {
    const auto query = make_query(backend);
    std::mt19937_64 random(7);
    const ColliderScene scene = random_scene(random, 20, 500, 0.0);
    query->place(scene.start, std::nullopt);
    std::vector<double> sums(4);
    std::vector<std::thread> threads;
    for (double& sum : sums)
      threads.emplace_back([&] {
        double total = 0.0;
        for (const Vec3& point : scene.points)
          for (int c = 0; c < 20; ++c) total += query->contact(point, c).distance;
        sum = total;
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_THAT(sums, ::testing::Each(sums[0]));
  }
}

} // namespace
