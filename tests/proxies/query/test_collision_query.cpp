// Every backend against a search along the axis, and the promises of proxies/query/collision_query.h.
#include "proxies/query/collision_query.h"

#include "proxies/motion/collider_motion.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/nearest_search.h"

#include <algorithm>
#include <array>
#include <gmock/gmock.h>
#include <limits>

using namespace tutu;
using namespace tutu::proxies;
using namespace tutu::test;

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array k_all = {Backend::fcl, Backend::hybrid, Backend::brute};
constexpr std::array k_searching = {Backend::fcl, Backend::hybrid}; // those that do not list every pair

/// The contact of a placed collider by the convention of proxies/contact.h; next to the axis the normal is noise.
Searched expect_right(const Contact& contact, const Vec3& point, const Capsule& capsule) {
  const Searched twin = search_point(point, capsule);
  const double scale = std::max(1.0, std::abs(twin.distance));
  EXPECT_NEAR(contact.distance, twin.distance, 1e-12 * scale);
  EXPECT_LE((contact.closest + contact.distance * contact.normal - point).norm(), 1e-12 * scale);
  EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
  if (twin.distance + capsule.radius_at(twin.t) > 1e-4) {
    EXPECT_LE((contact.normal - twin.normal).norm(), 1e-9);
  }
  return twin;
}

/// Whether a point is surely (but for grazes below 1e-5) within `reach` of a collider in one of these moments.
bool comes_near(const Vec3& point, const std::vector<std::vector<Capsule>>& moments, int collider, double reach) {
  return std::any_of(moments.begin(), moments.end(), [&](const std::vector<Capsule>& moment) {
    const Capsule& capsule = moment[collider];
    return least_distance(point, 0.0, capsule) <= reach && search_point(point, capsule, 20).distance <= reach;
  });
}

TEST(CollisionQuery, NamesAreThoseOfTheCommandLine) {
  for (const Backend backend : k_all)
    EXPECT_EQ(backend_named(k_backend_names[static_cast<std::size_t>(backend)]), backend);
  EXPECT_EQ(backend_named("hybrid"), Backend::hybrid);
  EXPECT_EQ(k_proxy_backend_names.size(), k_all.size());
  EXPECT_EQ(backend_named("mesh"), Backend::mesh);
  EXPECT_THROW(make_query(Backend::mesh), std::invalid_argument);
  EXPECT_THROW(backend_named("none"), std::invalid_argument);
}

TEST(CollisionQuery, OnlyHybridLeavesContactsToWhoAsks) {
  for (const Backend backend : k_all) EXPECT_EQ(make_query(backend)->leaves_contacts(), backend == Backend::hybrid);
}

TEST(CollisionQuery, IsRightOnRandomPairs) {
  for (const Backend backend : k_all) {
    const auto query = make_query(backend);
    std::mt19937_64 random(1);
    int inside = 0, cases = 0;
    for (int scene = 0; scene < 1000; ++scene) {
      std::vector<Capsule> colliders;
      for (int i = 0; i < 10; ++i)
        colliders.push_back({random_point(random, 0.3), random_point(random, 0.3), 0.3, random_taper(random, 0.3, i)});
      for (int i = 0; i < 10; i += 4) colliders[i].b = colliders[i].a, colliders[i].taper = 0.0;
      query->place(colliders, std::nullopt);
      for (int i = 0; i < 30; ++i, ++cases) {
        const Vec3 point = random_point(random, 0.32);
        inside += expect_right(query->contact(point, i % 10), point, colliders[i % 10]).distance < 0.0;
      }
    }
    EXPECT_EQ(cases, 30000);
    EXPECT_GT(inside, 0.3 * cases);
    EXPECT_LT(inside, 0.7 * cases);
  }
}

TEST(CollisionQuery, IsRightOnTheSurfaceOnTheAxisAndFarAway) {
  for (const Backend backend : k_all) {
    const auto query = make_query(backend);
    std::mt19937_64 random(2);
    for (int scene = 0; scene < 500; ++scene) {
      Capsule capsule{random_point(random, 1.0), random_point(random, 1.0), 0.2};
      if (scene % 5 == 0) capsule.b = capsule.a;
      if (scene % 5 == 1) capsule.b = capsule.a + Vec3(0, 0.5, 0);
      if (scene % 5 == 2) capsule.b = capsule.a + Vec3(0, 0, -0.5);
      query->place(std::vector{capsule}, std::nullopt);
      for (const double t : {0.0, 0.3, 1.0}) {
        const Vec3 on_axis = (1 - t) * capsule.a + t * capsule.b, axis = capsule.b - capsule.a;
        const Vec3 normal = query->contact(on_axis, 0).normal;
        expect_right(query->contact(on_axis, 0), on_axis, capsule);
        EXPECT_NEAR(normal.dot(axis), 0.0, 1e-12); // and of those the one that is up the most
        const double most_up = scene % 5 == 0 ? 1.0 : std::hypot(axis.x(), axis.z()) / axis.norm();
        EXPECT_NEAR(normal.y(), most_up, 1e-9);
      }
      const Vec3 point = random_point(random, 2.0);
      const Searched twin = search_point(point, capsule);
      const Vec3 on_surface = point - twin.distance * twin.normal;
      expect_right(query->contact(on_surface, 0), on_surface, capsule);
      const Vec3 far = random_point(random, 1e6);
      expect_right(query->contact(far, 0), far, capsule);
    }
  }
}

TEST(CollisionQuery, IsAsExactFarFromTheOrigin) {
  for (const Backend backend : k_all) {
    const auto query = make_query(backend);
    std::mt19937_64 random(3);
    const Vec3 away(1024, 0, -4096); // powers of two: the move itself costs 13 bits and no more
    for (int i = 0; i < 1000; ++i) {
      const Capsule capsule{away + random_point(random, 0.3), away + random_point(random, 0.3), 0.3};
      const Vec3 point = away + random_point(random, 0.3);
      query->place(std::vector{capsule}, std::nullopt);
      const Contact contact = query->contact(point, 0);
      EXPECT_NEAR(contact.distance, search_point(point, capsule).distance, 1e-11);
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-14);
    }
  }
}

TEST(CollisionQuery, GroundIsTheLastIndexOfEveryBackend) {
  const Plane ground{Vec3(0.6, 0.8, 0), 0.25};
  const std::vector<Capsule> colliders = {{Vec3(0, 50, 0), Vec3(0, 51, 0), 0.1}};
  const std::vector<Vec3> points = {Vec3(1, 2, 3), Vec3(-4, -5, -6)};
  for (const Backend backend : k_all) {
    const auto query = make_query(backend);
    Candidates candidates;
    query->find_candidates({colliders, colliders, ground}, points, 0.1, candidates);
    EXPECT_EQ(candidates.of(1).back(), 1);
    query->place(colliders, ground);
    for (const Vec3& point : points) {
      const Contact contact = query->contact(point, 1);
      EXPECT_NEAR(contact.distance, ground.normal.dot(point) - 0.25, 1e-15);
      EXPECT_EQ(contact.normal, ground.normal);
    }
  }
}

TEST(Candidates, NoneIsMissedAndFewAreFoundInVain) {
  for (const Backend backend : k_searching) {
    const auto query = make_query(backend);
    std::mt19937_64 random(4);
    Candidates candidates;
    long found = 0, near = 0, asked = 0;
    for (int frame = 0; frame < 100; ++frame) {
      ColliderScene scene = random_scene(random, 30, 200, 0.05);
      if (frame % 2) scene.ground = Plane{};
      const double reach = 0.001 * (frame % 50);
      query->find_candidates(scene.swept(), scene.points, reach, candidates);
      ASSERT_EQ(candidates.begin.size(), scene.points.size() + 1);
      std::vector<std::vector<Capsule>> moments;
      for (int s = 0; s <= 32; ++s) moments.push_back(scene.at(s / 32.0));
      for (int p = 0; p < 200; ++p) {
        std::vector<int> row(candidates.of(p).begin(), candidates.of(p).end());
        EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
        EXPECT_EQ(std::adjacent_find(row.begin(), row.end()), row.end());
        EXPECT_EQ(!row.empty() && row.back() == 30, scene.ground.has_value());
        for (int c = 0; c < 30; ++c) {
          const bool is_near = comes_near(scene.points[p], moments, c, reach);
          const bool listed = std::binary_search(row.begin(), row.end(), c);
          EXPECT_TRUE(listed || !is_near) << "frame " << frame << " point " << p << " collider " << c;
          near += is_near;
          found += listed;
          ++asked;
        }
      }
    }
    EXPECT_GT(near, asked / 100);     // representative: two points in five have one
    EXPECT_LT(10 * found, 16 * near); // selective
    RecordProperty("candidates_per_point", std::to_string(static_cast<double>(found) / (100 * 200)));
    RecordProperty("near_per_point", std::to_string(static_cast<double>(near) / (100 * 200)));
  }
}

TEST(Candidates, ExactlyAtReachIsWithinReach) {
  for (const Backend backend : k_searching) {
    const auto query = make_query(backend);
    const std::vector<Capsule> colliders = {{Vec3(0.1, 0.2, 0.3), Vec3(0.7, 0.2, 0.3), 0.1}};
    const std::vector<Vec3> points = {Vec3(0.4, 0.2 + 0.1 + 0.7, 0.3), Vec3(0.4, 0.2 + 0.1 + 0.7 + 1e-6, 0.3)};
    Candidates candidates;
    query->find_candidates({colliders, colliders, std::nullopt}, points, 0.7, candidates);
    EXPECT_THAT(candidates.of(0), ::testing::ElementsAre(0));
    EXPECT_THAT(candidates.of(1), ::testing::IsEmpty());
  }
}

TEST(Candidates, NumberOfCollidersMayChange) {
  for (const Backend backend : k_searching) {
    const auto query = make_query(backend);
    std::mt19937_64 random(5);
    Candidates candidates;
    for (const int count : {3, 0, 1, 40, 40, 2, 0, 200, 201, 0, 7}) {
      const ColliderScene scene = random_scene(random, count, 50, 0.02);
      query->find_candidates(scene.swept(), scene.points, 5.0, candidates); // everything is within reach
      for (int p = 0; p < 50; ++p) EXPECT_EQ(static_cast<int>(candidates.of(p).size()), count);
      query->place(scene.start, std::nullopt);
      for (int c = 0; c < count; ++c) expect_right(query->contact(scene.points[0], c), scene.points[0], scene.start[c]);
    }
    query->find_candidates({}, {}, 0.1, candidates);
    EXPECT_THAT(candidates.begin, ::testing::ElementsAre(0));
  }
}

TEST(Candidates, ManyFramesOfOneTreeMissNone) {
  for (const Backend backend : k_searching) {
    const auto query = make_query(backend);
    // The tree is refitted and rebalanced a little each frame: it must stay right however far the colliders wander.
    std::mt19937_64 random(6);
    ColliderScene scene = random_scene(random, 30, 100, 0.0);
    Candidates candidates;
    for (int frame = 0; frame < 500; ++frame) {
      scene.start = scene.end;
      for (Capsule& capsule : scene.end) {
        const Vec3 move = random_point(random, 0.1) - 0.02 * capsule.a;
        capsule.a += move;
        capsule.b += move;
      }
      query->find_candidates(scene.swept(), scene.points, 0.02, candidates);
      const std::vector<std::vector<Capsule>> middle = {scene.at(0.5)};
      for (int p = 0; p < 100; ++p)
        for (int c = 0; c < 30; ++c)
          if (comes_near(scene.points[p], middle, c, 0.02)) {
            EXPECT_THAT(candidates.of(p), ::testing::Contains(c));
          }
    }
  }
}

TEST(CollisionQuery, UnusableInputIsRefusedWithAReproduction) {
  const Capsule good{Vec3::Zero(), Vec3(0, 0.1, 0), 0.05};
  const std::vector<Vec3> points = {Vec3::Zero()};
  for (const Backend backend : k_all) {
    const auto query = make_query(backend);
    Candidates candidates;
    const auto find = [&](const std::vector<Capsule>& colliders, const std::vector<Vec3>& asked, double reach) {
      query->find_candidates({colliders, colliders, std::nullopt}, asked, reach, candidates);
    };
    find({good}, points, 0.0);
    Capsule bad = good;
    bad.b.z() = k_nan;
    EXPECT_THROW(find({good, bad}, points, 0.1), std::invalid_argument);
    EXPECT_THROW(query->place(std::vector{bad}, std::nullopt), std::invalid_argument);
    for (const double radius : {0.0, -1.0, k_nan, std::numeric_limits<double>::infinity()}) {
      EXPECT_THROW(find({{good.a, good.b, radius}}, points, 0.1), std::invalid_argument);
      EXPECT_THROW(query->place(std::vector{Capsule{good.a, good.b, radius}}, std::nullopt), std::invalid_argument);
    }
    for (const double reach : {-0.1, k_nan}) EXPECT_THROW(find({good}, points, reach), std::invalid_argument);
    EXPECT_THROW(find({good}, {Vec3(k_nan, 0, 0)}, 0.1), std::invalid_argument);
    const auto ask_box = [&](const Box& box) {
      query->find_for_boxes({std::vector{good}, std::vector{good}, std::nullopt}, std::vector{box}, candidates);
    };
    ask_box({Vec3::Zero(), Vec3::Zero()});
    for (const Box& box : {Box{}, Box{Vec3(0, 0, 1), Vec3::Zero()}, Box{Vec3::Zero(), Vec3(1, k_nan, 1)}})
      EXPECT_THROW(ask_box(box), std::invalid_argument);
    EXPECT_THROW(query->find_candidates({std::vector{good}, {}, std::nullopt}, points, 0.1, candidates),
                 std::invalid_argument);
    EXPECT_THROW(query->place({}, Plane{Vec3(0, 2, 0), 0.0}), std::invalid_argument);
    EXPECT_THROW(query->place({}, Plane{Vec3::UnitY(), k_nan}), std::invalid_argument);
    query->place(std::vector{good}, std::nullopt);
    EXPECT_THROW((void)query->contact(Vec3(0, std::numeric_limits<double>::infinity(), 0), 0), std::invalid_argument);
    try {
      query->place(std::vector{Capsule{Vec3(0.1, 0, 0), Vec3(0, 1.0 / 3.0, 0), -2.5}}, std::nullopt);
      FAIL();
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("collider 0 Capsule{{0.10000000000000001, 0, 0}, "
                                                     "{0, 0.33333333333333331, 0}, -2.5, 0}"));
    }
  }
}

TEST(Candidates, OfABoxAreTheCollidersThatTouchIt) {
  std::mt19937_64 random(9);
  for (const Backend backend : k_all) {
    const auto query = make_query(backend);
    Candidates candidates;
    long touching = 0, found = 0, asked = 0;
    for (const int count : {0, 1, 30, 30, 127, 128, 200, 30}) { // on both sides of hybrid's change from list to tree
      ColliderScene scene = random_scene(random, count, 0, 0.05);
      if (count % 2 == 0) scene.ground = Plane{};
      std::vector<Box> boxes;
      for (int i = 0; i < 200; ++i) {
        const Vec3 low = random_point(random, 0.5);
        boxes.emplace_back(low, low + Vec3::Constant(0.002 * (i % 100))); // some without size
      }
      query->find_for_boxes(scene.swept(), boxes, candidates);
      ASSERT_EQ(candidates.begin.size(), boxes.size() + 1);
      for (int i = 0; i < 200; ++i) {
        std::vector<int> expected;
        for (int c = 0; c < count; ++c)
          if (swept_box(scene.start[c], scene.end[c]).intersects(boxes[i])) expected.push_back(c);
        touching += static_cast<long>(expected.size());
        found += static_cast<long>(candidates.of(i).size()) - scene.ground.has_value();
        asked += count;
        if (scene.ground) expected.push_back(count);
        const std::vector<int> row(candidates.of(i).begin(), candidates.of(i).end());
        if (backend == Backend::brute) EXPECT_TRUE(std::ranges::includes(row, expected));
        else
          EXPECT_EQ(row, expected) << k_backend_names[static_cast<std::size_t>(backend)] << " box " << i << " of "
                                   << count << " colliders";
      }
    }
    EXPECT_GT(touching, asked / 20);
    EXPECT_LT(touching, asked / 2);
    EXPECT_EQ(found, backend == Backend::brute ? asked : touching);
    query->find_for_boxes({}, {}, candidates);
    EXPECT_THAT(candidates.begin, ::testing::ElementsAre(0));
  }
}

} // namespace
