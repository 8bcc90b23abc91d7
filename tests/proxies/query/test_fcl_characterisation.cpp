// What FCL 0.7 does, as far as the adapter leans on it or steps around it. A test that fails here after an upgrade of
// FCL tells which decision of broad_phase.cpp or narrow_phase.cpp to think over.
#include "proxies/distance/signed_distance.h"
#include "proxies/shapes.h"
#include "tests/support/collider_scenes.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/primitive_shape_algorithm/capsule_capsule.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <set>

using namespace tutu;
using tutu::test::random_point;

namespace {

fcl::Transform3d random_pose(std::mt19937_64& random, double extent) {
  std::normal_distribution<double> gauss;
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.linear() = Quat(gauss(random), gauss(random), gauss(random), gauss(random)).normalized().toRotationMatrix();
  pose.translation() = random_point(random, extent);
  return pose;
}

fcl::Transform3d at(const Vec3& place) {
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.translation() = place;
  return pose;
}

proxies::Capsule world_capsule(const fcl::Capsuled& shape, const fcl::Transform3d& pose) {
  return {pose * Vec3(0, 0, -0.5 * shape.lz), pose * Vec3(0, 0, 0.5 * shape.lz), shape.radius};
}

fcl::DistanceResultd unsigned_distance(const fcl::CollisionGeometryd& a, const fcl::Transform3d& pose_a,
                                       const fcl::CollisionGeometryd& b, const fcl::Transform3d& pose_b) {
  fcl::DistanceResultd result;
  fcl::distance(&a, pose_a, &b, pose_b, fcl::DistanceRequestd(true, false), result);
  return result;
}

/// A collision object whose box is written from outside, as the adapter's.
struct Boxed : fcl::CollisionObjectd {
  using fcl::CollisionObjectd::CollisionObjectd;
  void set_box(const Vec3& low, const Vec3& high) { aabb = fcl::AABBd(low, high); }
};

bool collect(fcl::CollisionObjectd* found, fcl::CollisionObjectd*, void* out) {
  static_cast<std::set<fcl::CollisionObjectd*>*>(out)->insert(found);
  return false;
}

std::set<fcl::CollisionObjectd*> touching(const fcl::BroadPhaseCollisionManagerd& manager, Boxed& query) {
  std::set<fcl::CollisionObjectd*> found;
  manager.collide(&query, &found, collect);
  return found;
}

// --- relied on -----------------------------------------------------------------------------------------------------

TEST(FclReliedOn, CapsuleCapsuleIsTheExactSignedDistanceAlsoInside) {
  std::mt19937_64 random(1);
  const fcl::Capsuled capsule(0.3, 0.4), particle(0.005, 0.0);
  int inside = 0;
  constexpr int k_cases = 10000;
  for (int i = 0; i < k_cases; ++i) {
    const fcl::Transform3d pose = random_pose(random, 0.2);
    const Vec3 point = random_point(random, 0.32);
    const fcl::DistanceResultd result = unsigned_distance(particle, at(point), capsule, pose);
    const proxies::Contact exact = proxies::signed_distance(point, world_capsule(capsule, pose));
    EXPECT_NEAR(result.min_distance + 0.005, exact.distance, 1e-15);
    EXPECT_LE((result.nearest_points[1] - exact.closest).norm(), 1e-11);
    inside += exact.distance < 0.0;
  }
  EXPECT_GT(inside, 0.3 * k_cases);
  EXPECT_LT(inside, 0.7 * k_cases);
}

TEST(FclReliedOn, TheClosedFormIsWhatDistanceCalls) {
  std::mt19937_64 random(2);
  const fcl::Capsuled capsule(0.1, 0.4), ball(1.0, 0.0);
  for (int i = 0; i < 1000; ++i) {
    const fcl::Transform3d pose = random_pose(random, 0.3), ball_pose = at(random_point(random, 0.3));
    double gap;
    Vec3 on_ball, on_capsule;
    ASSERT_TRUE(fcl::detail::capsuleCapsuleDistance(ball, ball_pose, capsule, pose, &gap, &on_ball, &on_capsule));
    const fcl::DistanceResultd result = unsigned_distance(ball, ball_pose, capsule, pose);
    EXPECT_EQ(gap, result.min_distance);
    EXPECT_EQ(on_ball, result.nearest_points[0]);
    EXPECT_EQ(on_capsule, result.nearest_points[1]);
  }
}

TEST(FclReliedOn, WitnessOfAUnitBallIsTheDirectionToTheAxis) {
  std::mt19937_64 random(3);
  const fcl::Capsuled capsule(0.3, 0.4), ball(1.0, 0.0);
  for (int i = 0; i < 1000; ++i) {
    const fcl::Transform3d pose = random_pose(random, 0.3);
    double gap;
    Vec3 witness, unused;
    fcl::detail::capsuleCapsuleDistance(ball, at(Vec3::Zero()), capsule, pose, &gap, &witness, &unused);
    const proxies::Contact exact = proxies::signed_distance(Vec3::Zero(), world_capsule(capsule, pose));
    EXPECT_NEAR(witness.norm(), 1.0, 1e-14);
    if (exact.distance > -0.299) { // off the axis
      EXPECT_LE((witness + exact.normal).norm(), 1e-12);
    }
  }
}

TEST(FclReliedOn, OnTheAxisDistanceIsExactAndWitnessesAreFinite) {
  const fcl::Capsuled capsule(0.3, 0.4), ball(1.0, 0.0);
  std::mt19937_64 random(4);
  for (int i = 0; i < 1000; ++i) {
    const fcl::Transform3d pose = random_pose(random, 1.0);
    for (const double z : {-0.2, 0.0, 0.2}) { // an end, the middle, the other end
      const Vec3 point = pose * Vec3(0, 0, z);
      const fcl::DistanceResultd result = unsigned_distance(ball, at(point), capsule, pose);
      EXPECT_NEAR(result.min_distance, -1.3, 1e-15);
      EXPECT_TRUE(result.nearest_points[0].allFinite() && result.nearest_points[1].allFinite());
    }
  }
  const fcl::DistanceResultd same_centre =
      unsigned_distance(ball, at(Vec3::Zero()), fcl::Capsuled(0.3, 0.0), at(Vec3::Zero()));
  EXPECT_EQ(same_centre.min_distance, -1.3);
}

TEST(FclReliedOn, TheTreeSeesBoxesWrittenByUsAfterUpdate) {
  const auto geometry = std::make_shared<fcl::Boxd>(1.0, 1.0, 1.0);
  Boxed object(geometry), other(geometry), query(geometry);
  object.set_box(Vec3::Constant(0), Vec3::Constant(1));
  other.set_box(Vec3::Constant(100), Vec3::Constant(101));
  query.set_box(Vec3::Constant(5), Vec3::Constant(6)); // the query's own box is read at once
  fcl::DynamicAABBTreeCollisionManagerd manager;
  manager.registerObjects({&object, &other});
  manager.setup();
  EXPECT_TRUE(touching(manager, query).empty());
  object.set_box(Vec3::Constant(5.5), Vec3::Constant(7));
  EXPECT_TRUE(touching(manager, query).empty()) << "seen before update()";
  manager.update();
  EXPECT_EQ(touching(manager, query), std::set<fcl::CollisionObjectd*>{&object});
  query.set_box(Vec3::Constant(1), Vec3::Constant(5.5)); // boxes that share a corner touch
  EXPECT_EQ(touching(manager, query), std::set<fcl::CollisionObjectd*>{&object});
  query.set_box(Vec3::Constant(100.2), Vec3::Constant(100.2)); // a box without size
  EXPECT_EQ(touching(manager, query), std::set<fcl::CollisionObjectd*>{&other});
}

TEST(FclReliedOn, TheTreeFindsExactlyTheTouchingBoxesFrameAfterFrame) {
  std::mt19937_64 random(5);
  const auto geometry = std::make_shared<fcl::Boxd>(1.0, 1.0, 1.0);
  std::vector<std::unique_ptr<Boxed>> objects;
  std::vector<fcl::CollisionObjectd*> pointers;
  for (int i = 0; i < 30; ++i) {
    objects.push_back(std::make_unique<Boxed>(geometry));
    objects.back()->set_box(Vec3::Zero(), Vec3::Ones());
    pointers.push_back(objects.back().get());
  }
  Boxed query(geometry);
  fcl::DynamicAABBTreeCollisionManagerd manager;
  manager.registerObjects(pointers);
  manager.setup();
  for (int frame = 0; frame < 200; ++frame) {
    for (auto& object : objects) {
      const Vec3 low = random_point(random, 1.0);
      object->set_box(low, low + Vec3::Constant(0.3));
    }
    manager.update();
    for (int i = 0; i < 20; ++i) {
      const Vec3 low = random_point(random, 1.0);
      query.set_box(low, low + Vec3::Constant(0.1));
      std::set<fcl::CollisionObjectd*> expected;
      for (auto& object : objects)
        if (object->getAABB().overlap(query.getAABB())) expected.insert(object.get());
      EXPECT_EQ(touching(manager, query), expected);
    }
  }
}

TEST(FclReliedOn, AnEmptyTreeMayBeAskedClearedAndFilledAgain) {
  const auto geometry = std::make_shared<fcl::Boxd>(1.0, 1.0, 1.0);
  Boxed object(geometry), query(geometry);
  object.set_box(Vec3::Zero(), Vec3::Ones());
  query.set_box(Vec3::Zero(), Vec3::Ones());
  fcl::DynamicAABBTreeCollisionManagerd manager;
  manager.registerObjects({});
  manager.setup();
  manager.update();
  EXPECT_TRUE(touching(manager, query).empty());
  for (int round = 0; round < 3; ++round) {
    manager.registerObjects({&object});
    manager.setup();
    manager.update();
    EXPECT_EQ(touching(manager, query).size(), 1u);
    manager.clear();
    EXPECT_TRUE(touching(manager, query).empty());
  }
}

// --- stepped around ------------------------------------------------------------------------------------------------

TEST(FclTrap, WitnessPointsCoincideOnTheSurfaceAndPassEachOtherInside) {
  // Why the normal is not taken from the difference of the witness points of a particle of no radius.
  const fcl::Capsuled capsule(0.25, 1.0), particle(0.0, 0.0);
  const auto difference = [&](double x) {
    const fcl::DistanceResultd result = unsigned_distance(particle, at({x, 0, 0}), capsule, at(Vec3::Zero()));
    return Vec3(result.nearest_points[1] - result.nearest_points[0]);
  };
  EXPECT_EQ(difference(0.5), Vec3(-0.25, 0, 0));
  EXPECT_EQ(difference(0.25), Vec3(0, 0, 0));
  EXPECT_EQ(difference(0.125), Vec3(0.125, 0, 0));
}

TEST(FclTrap, UnsignedSphereCapsuleIsMinusOneOnOverlap) {
  const fcl::Sphered sphere(0.1);
  const fcl::Capsuled capsule(0.2, 1.0);
  EXPECT_NEAR(unsigned_distance(sphere, at({1, 0, 0}), capsule, at(Vec3::Zero())).min_distance, 0.7, 1e-6);
  const fcl::DistanceResultd overlap = unsigned_distance(sphere, at({0.1, 0, 0}), capsule, at(Vec3::Zero()));
  EXPECT_EQ(overlap.min_distance, -1.0); // the depth is 0.2
  EXPECT_EQ(overlap.nearest_points[0], Vec3(0, 0, 0));
  EXPECT_EQ(overlap.nearest_points[1], Vec3(0, 0, 0));
}

TEST(FclTrap, CollideHasNoUsableNormalOnTheAxis) {
  const fcl::Sphered sphere(0.1);
  const fcl::Capsuled capsule(0.2, 1.0);
  const auto normal = [&](double z) {
    fcl::CollisionResultd result;
    fcl::collide<double>(&sphere, at({0, 0, z}), &capsule, at(Vec3::Zero()), fcl::CollisionRequestd(1, true), result);
    return result.numContacts() == 1 ? result.getContact(0).normal : Vec3::Constant(9);
  };
  EXPECT_EQ(normal(0.0), Vec3(0, 0, 0));  // none at all
  EXPECT_EQ(normal(0.1), Vec3(0, 0, -1)); // rounding noise, along the axis: not a way out
}

TEST(FclTrap, AResultThatIsNotClearedKeepsTheLeastOfAll) {
  const fcl::Capsuled capsule(0.2, 1.0), particle(0.1, 0.0);
  fcl::DistanceResultd result;
  const fcl::DistanceRequestd request(true, false);
  fcl::distance<double>(&particle, at({1, 0, 0}), &capsule, at(Vec3::Zero()), request, result);
  fcl::distance<double>(&particle, at({5, 0, 0}), &capsule, at(Vec3::Zero()), request, result);
  EXPECT_NEAR(result.min_distance, 0.7, 1e-15); // the first one's
  result.clear();
  fcl::distance<double>(&particle, at({5, 0, 0}), &capsule, at(Vec3::Zero()), request, result);
  EXPECT_NEAR(result.min_distance, 4.7, 1e-15);
}

TEST(FclTrap, NonFiniteInputDoesNotComeBackAsNonFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const fcl::Capsuled capsule(0.2, 1.0), particle(0.1, 0.0);
  const fcl::DistanceResultd result = unsigned_distance(particle, at({nan, 0, 0}), capsule, at(Vec3::Zero()));
  EXPECT_EQ(result.min_distance, std::numeric_limits<double>::max()); // "far away"
}

TEST(FclTrap, ComputeAabbBoundsATurnedCapsuleByItsSphere) {
  const auto capsule = std::make_shared<fcl::Capsuled>(0.1, 1.0);
  fcl::Transform3d lying = fcl::Transform3d::Identity();
  lying.linear() = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX()).toRotationMatrix();
  fcl::CollisionObjectd object(capsule, lying);
  const double tight = 0.2, loose = object.getAABB().height(); // along y, across the capsule
  EXPECT_GT(loose, 5.0 * tight);
  fcl::CollisionObjectd upright(capsule, at(Vec3::Zero()));
  EXPECT_NEAR(upright.getAABB().height(), tight, 1e-15);
}

} // namespace
