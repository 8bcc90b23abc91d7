// What FCL 0.7 does with meshes, as far as mesh_tree.cpp leans on it or steps around it.
#include "proxies/body/body_mesh.h"
#include "proxies/distance/feature_contact.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/solids.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>
#include <set>

using namespace tutu;
using namespace tutu::test;

namespace {

template <class Bounds> void fill(fcl::BVHModel<Bounds>& model, const Surface& surface) {
  std::vector<fcl::Triangle> triangles;
  for (const rig::Triangle& t : surface.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model.beginModel();
  model.addSubModel(surface.points(), triangles);
  model.endModel();
}

template <class Bounds> void refit(fcl::BVHModel<Bounds>& model, const std::vector<Vec3>& points, bool bottom_up) {
  model.beginReplaceModel();
  model.replaceSubModel(points);
  model.endReplaceModel(true, bottom_up);
}

/// Shaken hard, so that a refitted box has nothing of the first one left.
std::vector<Vec3> shaken(const Surface& surface, std::mt19937_64& random) {
  std::vector<Vec3> points = surface.points();
  for (Vec3& p : points) p = 2.0 * p + random_point(random, 0.3) + Vec3(1.0, 0.0, 0.0);
  return points;
}

proxies::Capsule random_capsule(std::mt19937_64& random) {
  std::uniform_real_distribution<double> radius(0.02, 0.25);
  const Vec3 a = random_point(random, 0.9);
  return {a, random() % 3 == 0 ? a : Vec3(a + random_point(random, 0.5)), radius(random)};
}

fcl::Transform3d pose_of(const proxies::Capsule& capsule) {
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.linear() = rotation_between(Vec3::UnitZ(), capsule.b - capsule.a).toRotationMatrix();
  pose.translation() = 0.5 * (capsule.a + capsule.b);
  return pose;
}

// --- relied on -----------------------------------------------------------------------------------------------------

TEST(FclMeshReliedOn, ATreeHasOneTriangleALeafAndChildrenSideBySideAfterTheirParent) {
  fcl::BVHModel<fcl::AABBd> model;
  const Surface sphere = sphere_surface(1.0, 3);
  fill(model, sphere);
  EXPECT_EQ(model.getNumBVs(), 2 * static_cast<int>(sphere.triangles.size()) - 1);
  std::set<int> triangles;
  for (int i = 0; i < model.getNumBVs(); ++i) {
    const auto& node = model.getBV(i);
    if (node.isLeaf()) {
      EXPECT_EQ(node.first_child, -1 - node.primitiveId());
      triangles.insert(node.primitiveId());
      continue;
    }
    EXPECT_EQ(node.leftChild(), node.first_child);
    EXPECT_EQ(node.rightChild(), node.leftChild() + 1);
    EXPECT_GT(node.leftChild(), i);
  }
  EXPECT_EQ(triangles.size(), sphere.triangles.size());
}

TEST(FclMeshReliedOn, BottomUpRefitOfBoxesIsExact) {
  std::mt19937_64 random(1);
  fcl::BVHModel<fcl::AABBd> model;
  const Surface sphere = sphere_surface(1.0, 3);
  fill(model, sphere);
  for (int frame = 0; frame < 5; ++frame) {
    const std::vector<Vec3> points = shaken(sphere, random);
    refit(model, points, true);
    std::vector<proxies::Box> boxes(model.getNumBVs());
    for (int i = model.getNumBVs() - 1; i >= 0; --i) {
      const auto& node = model.getBV(i);
      if (node.isLeaf())
        for (const std::uint32_t v : sphere.triangles[node.primitiveId()]) boxes[i].extend(points[v]);
      else boxes[i] = boxes[node.leftChild()].merged(boxes[node.rightChild()]);
      EXPECT_EQ(node.bv.min_, boxes[i].min());
      EXPECT_EQ(node.bv.max_, boxes[i].max());
    }
  }
}

TEST(FclMeshReliedOn, CollideSaysRightlyWhichTrianglesACapsuleTouches) {
  std::mt19937_64 random(2);
  const Surface spiky = spiky_surface(random);
  const proxies::BodyMesh body(spiky.positions, spiky.triangles);
  int touching = 0, close = 0, inside = 0;
  constexpr int k_cases = 2000;
  for (int i = 0; i < k_cases; ++i) {
    proxies::Capsule capsule = random_capsule(random);
    if (i % 100 > 0) capsule.taper = test::random_taper(random, capsule.radius, i);
    std::vector<int> surely, maybe; // GJK stops within some 1e-6 m
    for (std::size_t t = 0; t < spiky.triangles.size(); ++t) {
      const rig::Triangle& v = spiky.triangles[t];
      const double distance = proxies::triangle_contact(body.positions()[v[0]], body.positions()[v[1]],
                                                        body.positions()[v[2]], capsule, Vec3::Zero())
                                  .distance;
      if (distance <= -1e-6) surely.push_back(static_cast<int>(t));
      if (distance <= 1e-6) maybe.push_back(static_cast<int>(t));
    }
    const proxies::MeshHits hits = body.hits(capsule);
    EXPECT_TRUE(std::ranges::includes(hits.triangles, surely)) << i;
    EXPECT_TRUE(std::ranges::includes(maybe, hits.triangles)) << i;
    EXPECT_EQ(hits.hit(), !surely.empty() || body.is_inside(capsule.a)) << i;
    touching += !surely.empty();
    close += surely != maybe;
    inside += hits.inside;

    fcl::BVHModel<fcl::AABBd> model; // what the adapter leaves out of fcl::collide makes no difference
    if (i % 100 > 0) continue;
    fill(model, spiky);
    const fcl::Capsuled shape(capsule.radius, (capsule.b - capsule.a).norm());
    fcl::CollisionResultd result;
    fcl::collide(&model, fcl::Transform3d::Identity(), &shape, pose_of(capsule),
                 fcl::CollisionRequestd(spiky.triangles.size(), false), result);
    std::set<int> by_collide;
    for (std::size_t c = 0; c < result.numContacts(); ++c) by_collide.insert(static_cast<int>(result.getContact(c).b1));
    EXPECT_EQ(by_collide, std::set<int>(hits.triangles.begin(), hits.triangles.end()));
  }
  EXPECT_GT(touching, 0.3 * k_cases);
  EXPECT_LT(touching, 0.7 * k_cases);
  EXPECT_GT(inside, 20);
  EXPECT_LT(close, 5);
}

// --- stepped around ------------------------------------------------------------------------------------------------

TEST(FclMeshTrap, ACapsuleWhollyInsideDoesNotCollide) {
  fcl::BVHModel<fcl::AABBd> model;
  const Surface sphere = sphere_surface(1.0, 3);
  fill(model, sphere);
  const fcl::Capsuled capsule(0.1, 0.2);
  fcl::CollisionResultd result;
  fcl::collide(&model, fcl::Transform3d::Identity(), &capsule, fcl::Transform3d::Identity(),
               fcl::CollisionRequestd(1, false), result);
  EXPECT_FALSE(result.isCollision());
  const proxies::MeshHits hits =
      proxies::BodyMesh(sphere.positions, sphere.triangles).hits({{0, 0, -0.1}, {0, 0, 0.1}, 0.1});
  EXPECT_TRUE(hits.triangles.empty());
  EXPECT_TRUE(hits.inside);
}

TEST(FclMeshTrap, DistanceKnowsNoBoxes) {
  fcl::BVHModel<fcl::AABBd> model;
  fill(model, sphere_surface(1.0, 2));
  const fcl::Sphered point(0.0);
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.translation().x() = 3.0;
  fcl::DistanceResultd result;
  fcl::distance(&model, fcl::Transform3d::Identity(), &point, pose, fcl::DistanceRequestd(true, false), result);
  EXPECT_EQ(result.min_distance, std::numeric_limits<double>::max()); // it is 2
}

TEST(FclMeshTrap, BottomUpRefitOfSweptSpheresLosesPoints) {
  std::mt19937_64 random(3);
  const Surface sphere = sphere_surface(1.0, 3);
  fcl::BVHModel<fcl::RSSd> model;
  fill(model, sphere);
  const std::vector<Vec3> points = shaken(sphere, random);
  refit(model, points, true);
  const proxies::BodyMesh exact = [&] {
    proxies::BodyMesh body(sphere.positions, sphere.triangles);
    body.pose(points);
    return body;
  }();
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    const fcl::Sphered point(0.0);
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.translation() = random_point(random, 3.0);
    fcl::DistanceResultd result;
    fcl::distance(&model, fcl::Transform3d::Identity(), &point, pose, fcl::DistanceRequestd(true, false), result);
    worst =
        std::max(worst, std::abs(result.min_distance -
                                 exact.nearest(pose.translation(), std::numeric_limits<double>::infinity())->distance));
  }
  EXPECT_GT(worst, 0.01); // m: why the tree is of boxes
}

} // namespace
