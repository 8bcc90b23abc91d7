// FCL's continuous collision next to ours, where only translations are at play: a witness from outside for sweep.h, and
// why the default of FCL is not one.
#include "proxies/motion/sweep.h"
#include "tests/support/collider_scenes.h"

#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::proxies;
using tutu::test::random_point;

namespace {

constexpr double k_particle = 0.005; // m

struct Case {
  Vec3 from, to;
  Capsule start, end;
};

Case random_case(std::mt19937_64& random) {
  Case one;
  one.start = {random_point(random, 0.2), random_point(random, 0.2), 0.05};
  const Vec3 move = random_point(random, 0.05);
  one.end = {one.start.a + move, one.start.b + move, 0.05};
  one.from = random_point(random, 0.3);
  one.to = one.from + 2.0 * (0.5 * (one.start.a + one.start.b) + random_point(random, 0.1) - one.from);
  return one;
}

/// FCL's time of contact; 2 where it finds none.
double fcl_time(const Case& one, const fcl::ContinuousCollisionRequestd& request) {
  const Vec3 axis = one.start.b - one.start.a;
  const fcl::Capsuled capsule(one.start.radius, axis.norm());
  const fcl::Sphered particle(k_particle);
  const auto pose = [](const Eigen::Matrix3d& rotation, const Vec3& place) {
    fcl::Transform3d result = fcl::Transform3d::Identity();
    result.linear() = rotation;
    result.translation() = place;
    return result;
  };
  const Eigen::Matrix3d along = rotation_between(Vec3::UnitZ(), axis).toRotationMatrix(), still = along.Identity();
  fcl::ContinuousCollisionResultd result;
  fcl::continuousCollide<double>(&particle, pose(still, one.from), pose(still, one.to), &capsule,
                                 pose(along, 0.5 * (one.start.a + one.start.b)),
                                 pose(along, 0.5 * (one.end.a + one.end.b)), request, result);
  return result.is_collide ? result.time_of_contact : 2.0;
}

TEST(FclSweep, ConservativeAdvancementFindsWhatOursFinds) {
  std::mt19937_64 random(1);
  const fcl::ContinuousCollisionRequestd request(1000, 1e-5, fcl::CCDM_TRANS, fcl::GST_LIBCCD,
                                                 fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
  int touches = 0, cases = 0, apart = 0;
  for (; cases < 1000; ++cases) {
    const Case one = random_case(random);
    const auto ours = time_of_impact(one.from, one.to, one.start, one.end, k_particle);
    const double theirs = fcl_time(one, request);
    touches += ours.has_value();
    if (ours.has_value() != (theirs <= 1.0)) ++apart; // a graze
    else if (ours) {
      EXPECT_NEAR(ours->time, theirs, 1e-4) << cases;
    }
  }
  EXPECT_LE(apart, cases / 200);
  EXPECT_GT(touches, 0.3 * cases);
  EXPECT_LT(touches, 0.7 * cases);
}

TEST(FclTrap, NaiveContinuousCollisionIsLateAndMisses) {
  std::mt19937_64 random(2);
  const fcl::ContinuousCollisionRequestd as_it_comes;
  EXPECT_EQ(as_it_comes.ccd_solver_type, fcl::CCDC_NAIVE);
  int late = 0, missed = 0;
  for (int i = 0; i < 1000; ++i) {
    const Case one = random_case(random);
    const auto ours = time_of_impact(one.from, one.to, one.start, one.end, k_particle);
    if (!ours || ours->time == 0.0) continue;
    const double theirs = fcl_time(one, as_it_comes);
    missed += theirs > 1.0;
    late += theirs <= 1.0 && theirs > ours->time + 1e-3;
  }
  EXPECT_GT(late, 100);
  EXPECT_GT(missed, 10);
  RecordProperty("late", late);
  RecordProperty("missed", missed);
}

} // namespace
