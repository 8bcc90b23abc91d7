// The backend `mesh`: the true body and the ground as cloth asks them.
#include "proxies/query/collision_query.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/solids.h"

#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

using namespace tutu;
using namespace tutu::proxies;
using namespace tutu::test;

namespace {

struct Moving {
  Surface at_start = sphere_surface(0.3, 3), at_end = at_start;
  std::unique_ptr<CollisionQuery> query = make_mesh_query(BodyMesh(at_start.positions, at_start.triangles));

  Moving() { // carried along and stretched
    for (Vec3f& p : at_end.positions) p = Vec3f(1.5f * p.x() + 0.2f, p.y(), p.z());
  }
  SweptColliders swept(std::optional<Plane> ground) const {
    return {{}, {}, ground, {}, at_start.positions, at_end.positions};
  }
  void place(double s) {
    query->body()->begin_frame(at_start.positions, at_end.positions);
    query->body()->place(s);
  }
};

TEST(MeshQuery, TheBodyIsWhereItsVerticesAreAtThatMoment) {
  Moving moving;
  EXPECT_FALSE(moving.query->leaves_contacts());
  const SweptColliders swept = moving.swept(Plane{Vec3::UnitY(), -1.0});
  std::mt19937_64 random(1);
  for (const double s : {0.0, 0.25, 1.0}) {
    moving.query->place({}, swept.ground);
    moving.place(s);
    Surface now = moving.at_start;
    for (std::size_t v = 0; v < now.positions.size(); ++v)
      now.positions[v] += static_cast<float>(s) * (moving.at_end.positions[v] - now.positions[v]);
    const BodyMesh exact(now.positions, now.triangles);
    for (int i = 0; i < 200; ++i) {
      const Vec3 point = random_point(random, 0.6);
      EXPECT_NEAR(moving.query->contact(point, swept.body_index()).distance, exact.signed_distance(point).distance,
                  1e-6); // single precision of `now`
      EXPECT_EQ(moving.query->contact(point, swept.ground_index()).distance, point.y() + 1.0);
    }
  }
}

TEST(MeshQuery, ItsSurfaceGoesWithTheNearestTriangle) {
  Moving moving;
  const SweptColliders swept = moving.swept(std::nullopt);
  moving.place(0.0);
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 1), Vec3(-1, 2, 0.5)}) {
    const Vec3 point = 0.32 * direction.normalized();
    const double x = moving.query->contact(point, swept.body_index()).closest.x();
    EXPECT_LT((moving.query->body()->way(point) - Vec3(0.5 * x + 0.2, 0, 0)).norm(), 1e-6);
  }
}

TEST(MeshQuery, BodyAndGroundAreAlwaysCandidates) {
  Moving moving;
  Candidates candidates;
  const std::vector<Vec3> points = {{0, 0, 0}, {9, 9, 9}};
  const SweptColliders on_ground = moving.swept(Plane{}), floating = moving.swept(std::nullopt);
  moving.query->find_candidates(on_ground, points, 0.01, candidates);
  EXPECT_EQ(candidates.colliders, (std::vector{0, 1, 0, 1}));
  EXPECT_EQ(on_ground.ground_index(), 0);
  EXPECT_EQ(on_ground.body_index(), 1);
  moving.query->find_candidates(floating, points, 0.01, candidates);
  EXPECT_EQ(candidates.colliders, (std::vector{1, 1}));
}

TEST(MeshQuery, WhatDoesNotFitIsRefused) {
  Moving moving;
  const std::vector<Capsule> limb = {{Vec3::Zero(), Vec3::Zero(), 0.1}};
  Candidates candidates;
  const std::vector<Vec3> points = {Vec3::Zero()};
  SweptColliders swept = moving.swept(std::nullopt);
  swept.start = swept.end = limb;
  EXPECT_THROW(moving.query->find_candidates(swept, points, 0.01, candidates), std::invalid_argument);
  EXPECT_THROW(moving.query->place(limb, std::nullopt), std::invalid_argument);
  swept = moving.swept(std::nullopt);
  swept.body_end = swept.body_end.first(3);
  EXPECT_THROW(moving.query->find_candidates(swept, points, 0.01, candidates), std::invalid_argument);
  EXPECT_THROW(moving.query->find_candidates({}, points, 0.01, candidates), std::invalid_argument);
  moving.at_end.positions[3].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(moving.place(0.5), std::invalid_argument);
}

} // namespace
