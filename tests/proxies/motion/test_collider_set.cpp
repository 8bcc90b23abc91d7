#include "proxies/motion/collider_set.h"

#include "tests/support/collider_scenes.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::proxies;
using tutu::test::random_point;

namespace {

std::vector<Transform> random_joints(std::mt19937_64& random, int count) {
  std::normal_distribution<double> gauss;
  std::vector<Transform> joints(count);
  for (Transform& joint : joints)
    joint = {Quat(gauss(random), gauss(random), gauss(random), gauss(random)).normalized(), random_point(random, 1.0)};
  return joints;
}

Anchor on_joint(int joint, const Vec3& point) {
  Anchor anchor;
  anchor.count = 1;
  anchor.joints[0] = joint;
  anchor.weights[0] = 1.0;
  anchor.points[0] = point;
  return anchor;
}

std::vector<Proxy> three_proxies() {
  const Anchor a = on_joint(0, {0.1, 0.2, 0.3}), b = on_joint(1, {-0.1, 0, 0.4});
  return {{"ball", ProxyKind::sphere, a, a, 0.1, 0.3, true},
          {"off", ProxyKind::capsule, a, b, 0.2, 0.3, false},
          {"limb", ProxyKind::capsule, a, b, 0.3, 0.5, true}};
}

bool same(const Capsule& p, const Capsule& q) { return p.a == q.a && p.b == q.b && p.radius == q.radius; }

TEST(Anchor, OneJointCarriesItsPoint) {
  std::mt19937_64 random(1);
  const std::vector<Transform> joints = random_joints(random, 3);
  EXPECT_EQ(on_joint(2, {0.1, 0.2, 0.3}).place(joints), joints[2] * Vec3(0.1, 0.2, 0.3));
}

TEST(Anchor, SeveralJointsBlendAsASkinnedVertexDoes) {
  std::mt19937_64 random(2);
  const std::vector<Transform> joints = random_joints(random, 5);
  Anchor anchor;
  anchor.count = 4;
  anchor.joints = {4, 0, 2, 1};
  anchor.weights = {0.4, 0.3, 0.2, 0.1};
  for (Vec3& point : anchor.points) point = random_point(random, 1.0);
  Vec3 expected = Vec3::Zero();
  for (int k = 0; k < 4; ++k)
    expected += anchor.weights[k] * (joints[anchor.joints[k]].rotation.toRotationMatrix() * anchor.points[k] +
                                     joints[anchor.joints[k]].translation);
  EXPECT_LE((anchor.place(joints) - expected).norm(), 1e-15);
}

TEST(ColliderSet, LeavesDisabledProxiesOut) {
  const ColliderSet set(three_proxies(), Plane{});
  ASSERT_EQ(set.size(), 2);
  EXPECT_EQ(set.proxies()[1].name, "limb");
  EXPECT_EQ(set.swept().size(), 2);
  EXPECT_EQ(set.swept().ground_index(), 2);
  EXPECT_EQ(set.swept().start[1].radius, 0.3);
  EXPECT_EQ(ColliderSet({}, std::nullopt).swept().size(), 0);
}

TEST(ColliderSet, AdvancesFromPoseToPose) {
  std::mt19937_64 random(3);
  const auto first = random_joints(random, 2), second = random_joints(random, 2), third = random_joints(random, 2);
  ColliderSet set(three_proxies(), std::nullopt);
  set.reset(first);
  for (int i = 0; i < set.size(); ++i) EXPECT_TRUE(same(set.swept().start[i], set.swept().end[i]));
  set.advance(second);
  EXPECT_EQ(set.swept().start[1].b, first[1] * Vec3(-0.1, 0, 0.4));
  EXPECT_EQ(set.swept().end[1].b, second[1] * Vec3(-0.1, 0, 0.4));
  EXPECT_EQ(set.swept().end[0].a, set.swept().end[0].b); // a sphere
  set.advance(third);
  EXPECT_EQ(set.swept().start[1].a, second[0] * Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(set.swept().end[1].a, third[0] * Vec3(0.1, 0.2, 0.3));
  set.reset(first);
  EXPECT_EQ(set.swept().start[1].a, first[0] * Vec3(0.1, 0.2, 0.3));
}

TEST(ColliderSet, SpinIsTheTurnOfTheJointThatCarriesMost) {
  std::mt19937_64 random(6);
  std::vector<Proxy> proxies = three_proxies();
  proxies[0].a.count = 2; // mostly on joint 1
  proxies[0].a.joints = {0, 1};
  proxies[0].a.weights = {0.3, 0.7};
  ColliderSet set(proxies, std::nullopt);
  std::vector<Transform> joints = random_joints(random, 2);
  set.reset(joints);
  EXPECT_EQ(set.swept().spin.size(), 2u);
  EXPECT_EQ(set.swept().spin[0], Vec3::Zero());
  set.advance(joints);
  for (const Vec3& spin : set.swept().spin) EXPECT_EQ(spin, Vec3::Zero()) << "to the bit";
  for (int frame = 0; frame < 200; ++frame) {
    const std::vector<Transform> before = joints;
    std::uniform_real_distribution<double> angle(0.0, 3.1);
    const Vec3 axes[2] = {random_point(random, 1.0).normalized(), random_point(random, 1.0).normalized()};
    const double angles[2] = {angle(random), 1e-6 * angle(random)};
    for (int j = 0; j < 2; ++j) {
      joints[j].rotation = Quat(Eigen::AngleAxisd(angles[j], axes[j])) * joints[j].rotation;
      if (frame % 2) joints[j].rotation.coeffs() *= -1.0; // the same rotation
    }
    set.advance(joints);
    EXPECT_LE((set.swept().spin[0] - angles[1] * axes[1]).norm(), 1e-14); // the ball
    EXPECT_LE((set.swept().spin[1] - angles[0] * axes[0]).norm(), 1e-12); // the limb
  }
  set.reset(random_joints(random, 2));
  for (const Vec3& spin : set.swept().spin) EXPECT_EQ(spin, Vec3::Zero());
}

TEST(ColliderSet, EndsOfTheFrameAreExact) {
  std::mt19937_64 random(4);
  ColliderSet set(three_proxies(), std::nullopt);
  set.reset(random_joints(random, 2));
  std::vector<Capsule> now(set.size());
  for (int frame = 0; frame < 200; ++frame) {
    set.advance(random_joints(random, 2));
    colliders_at(set.swept(), 0.0, now);
    for (int i = 0; i < set.size(); ++i) EXPECT_TRUE(same(now[i], set.swept().start[i]));
    colliders_at(set.swept(), 1.0, now);
    for (int i = 0; i < set.size(); ++i) EXPECT_TRUE(same(now[i], set.swept().end[i]));
    colliders_at(set.swept(), 0.25, now);
    EXPECT_LE((now[0].a - (0.75 * set.swept().start[0].a + 0.25 * set.swept().end[0].a)).norm(), 1e-15);
    EXPECT_TRUE(same(now[1], capsule_at(set.swept().start[1], set.swept().end[1], 0.25)));
  }
}

TEST(ColliderSet, WhatStandsStillStandsStillToTheBit) {
  std::mt19937_64 random(5);
  ColliderSet set(three_proxies(), std::nullopt);
  const auto joints = random_joints(random, 2);
  set.reset(joints);
  set.advance(joints);
  std::vector<Capsule> now(set.size());
  for (double s = 0.0; s <= 1.0; s += 0.01) {
    colliders_at(set.swept(), s, now);
    for (int i = 0; i < set.size(); ++i) EXPECT_TRUE(same(now[i], set.swept().start[i]));
  }
}

} // namespace
