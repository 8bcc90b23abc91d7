#include "rig/drag.h"
#include "tests/rig/random_skeleton.h"

#include <gtest/gtest.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;

namespace {

std::vector<Transform> model_of(const Skeleton& skeleton, const std::vector<Transform>& local) {
  std::vector<Transform> model(local.size());
  model_from_local(skeleton, local, model);
  return model;
}

bool same(const std::vector<Transform>& a, const std::vector<Transform>& b) {
  for (std::size_t j = 0; j < a.size(); ++j)
    if (a[j].rotation.coeffs() != b[j].rotation.coeffs() || a[j].translation != b[j].translation) return false;
  return true;
}

/// The formula once more, with rotation matrices only: Rodrigues for R(theta, n).
Eigen::Matrix3d dragged_rotation(const Eigen::Matrix3d& r_grandparent, const Eigen::Matrix3d& r_parent,
                                 const Vec3& centre, const Vec3& joint, const Vec3& target) {
  const Vec3 u = (joint - centre).normalized(), v = (target - centre).normalized();
  const double theta = std::acos(std::clamp(u.dot(v), -1.0, 1.0));
  const Vec3 n = u.cross(v).normalized();
  Eigen::Matrix3d cross;
  cross << 0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0;
  const Eigen::Matrix3d r =
      Eigen::Matrix3d::Identity() + std::sin(theta) * cross + (1.0 - std::cos(theta)) * cross * cross;
  return r_grandparent.transpose() * r * r_grandparent * r_parent;
}

/// Root, arm, and two fingers on the arm's end.
Skeleton small_tree() {
  Skeleton skeleton;
  skeleton.names = {"root", "arm", "finger", "thumb"};
  skeleton.parents = {k_no_parent, 0, 1, 1};
  skeleton.rest_local = {{Quat::Identity(), {0, 1, 0}},
                         {Quat::Identity(), {0.5, 0, 0}},
                         {Quat::Identity(), {0.25, 0, 0}},
                         {Quat::Identity(), {0, 0.125, 0}}};
  return skeleton;
}

TEST(Drag, NearestPointOfTheSphereAgainstBruteForce) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 50; ++round) {
    const Vec3 centre = test::random_vector(random), joint = test::random_vector(random),
               target = test::random_vector(random);
    const Vec3 nearest = nearest_on_bone_sphere(centre, joint, target);
    const double radius = (joint - centre).norm();
    EXPECT_NEAR((nearest - centre).norm(), radius, 1e-14);
    const double distance = (nearest - target).norm();
    EXPECT_NEAR(distance, std::abs((target - centre).norm() - radius), 1e-14);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 other = centre + radius * test::random_vector(random).normalized();
      EXPECT_GE((other - target).norm(), distance - 1e-14);
    }
  }
}

TEST(Drag, NearestPointOfDegenerateSpheres) {
  const Vec3 centre(1, 2, 3), joint(1, 2, 4);
  EXPECT_EQ(nearest_on_bone_sphere(centre, joint, centre), joint);
  EXPECT_EQ(nearest_on_bone_sphere(centre, centre, {5, 5, 5}), centre);
}

TEST(Drag, TurnsTheParentByTheFormula) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 200; ++round) {
    const Skeleton skeleton = test::random_skeleton(random, 12);
    std::vector<Transform> local = test::random_pose(random, skeleton);
    const std::vector<Transform> before = model_of(skeleton, local), local_before = local;
    const int joint = std::uniform_int_distribution<int>(1, 11)(random), parent = skeleton.parents[joint];
    const int grandparent = skeleton.parents[parent];
    const Vec3 target = test::random_vector(random);
    drag_joint(skeleton, local, joint, target);

    const Eigen::Matrix3d r_grandparent = grandparent == k_no_parent ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                                                     : before[grandparent].rotation.toRotationMatrix();
    const Eigen::Matrix3d expected = dragged_rotation(r_grandparent, local_before[parent].rotation.toRotationMatrix(),
                                                      before[parent].translation, before[joint].translation, target);
    EXPECT_LT((local[parent].rotation.toRotationMatrix() - expected).norm(), 1e-12);

    // Only the parent's rotation has changed, and the joint is at the nearest point of its sphere.
    local[parent].rotation = local_before[parent].rotation;
    EXPECT_TRUE(same(local, local_before));
  }
}

TEST(Drag, TheJointEndsAtTheNearestPoint) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 200; ++round) {
    const Skeleton skeleton = test::random_skeleton(random, 20);
    std::vector<Transform> local = test::random_pose(random, skeleton);
    const std::vector<Transform> before = model_of(skeleton, local);
    const int joint = std::uniform_int_distribution<int>(1, 19)(random), parent = skeleton.parents[joint];
    const Vec3 target = test::random_vector(random);
    drag_joint(skeleton, local, joint, target);
    const Vec3 expected = nearest_on_bone_sphere(before[parent].translation, before[joint].translation, target);
    EXPECT_LT((model_of(skeleton, local)[joint].translation - expected).norm(), 1e-12);
  }
}

TEST(Drag, BoneLengthsOutlastAThousandDrags) {
  std::mt19937_64 random(4);
  const Skeleton skeleton = test::random_skeleton(random, 40);
  std::vector<Transform> local = skeleton.rest_local;
  for (int i = 0; i < 1000; ++i)
    drag_joint(skeleton, local, std::uniform_int_distribution<int>(0, 39)(random), test::random_vector(random));
  const std::vector<Transform> model = model_of(skeleton, local), rest = rest_model(skeleton);
  for (int j = 1; j < 40; ++j) {
    const int parent = skeleton.parents[j];
    EXPECT_NEAR((model[j].translation - model[parent].translation).norm(),
                (rest[j].translation - rest[parent].translation).norm(), 1e-9);
    EXPECT_NEAR(local[j].rotation.norm(), 1.0, 1e-14);
  }
}

TEST(Drag, SiblingsTurnAlong) {
  const Skeleton skeleton = small_tree();
  std::vector<Transform> local = skeleton.rest_local;
  drag_joint(skeleton, local, 2, {0.5, 7, 0}); // the finger straight up: the arm's end turns by 90 degrees about Z
  const std::vector<Transform> model = model_of(skeleton, local);
  EXPECT_LT((model[1].translation - Vec3(0.5, 1, 0)).norm(), 1e-15);
  EXPECT_LT((model[2].translation - Vec3(0.5, 1.25, 0)).norm(), 1e-15);
  EXPECT_LT((model[3].translation - Vec3(0.375, 1, 0)).norm(), 1e-15);
}

TEST(Drag, AParentThatIsARootHasNoGrandparent) {
  const Skeleton skeleton = small_tree();
  std::vector<Transform> local = skeleton.rest_local;
  local[0].rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  const Quat before = local[0].rotation;
  const Vec3 bone = before * Vec3(0.5, 0, 0);
  drag_joint(skeleton, local, 1, {0, 1, 5});
  EXPECT_LT((model_of(skeleton, local)[1].translation - Vec3(0, 1, 0.5)).norm(), 1e-15);
  EXPECT_LT((local[0].rotation.coeffs() - (rotation_between(bone, Vec3::UnitZ()) * before).coeffs()).norm(), 1e-15);
}

TEST(Drag, OppositeTargetsTurnHalfRound) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 50; ++round) {
    const Skeleton skeleton = test::random_skeleton(random, 10);
    std::vector<Transform> local = test::random_pose(random, skeleton);
    const std::vector<Transform> before = model_of(skeleton, local);
    const int joint = std::uniform_int_distribution<int>(1, 9)(random), parent = skeleton.parents[joint];
    const Vec3 opposite = 2.0 * before[parent].translation - before[joint].translation;
    drag_joint(skeleton, local, joint, opposite);
    const std::vector<Transform> after = model_of(skeleton, local);
    EXPECT_LT((after[joint].translation - opposite).norm(), 1e-5); // at opposite to 1e-12 any half turn will do
    EXPECT_NEAR(before[parent].rotation.angularDistance(after[parent].rotation), std::numbers::pi, 1e-5);
  }
}

TEST(Drag, AZeroDragChangesNothing) {
  std::mt19937_64 random(6);
  for (int round = 0; round < 200; ++round) {
    const Skeleton skeleton = test::random_skeleton(random, 20);
    std::vector<Transform> local = test::random_pose(random, skeleton);
    const std::vector<Transform> before = local, model = model_of(skeleton, local);
    const int joint = std::uniform_int_distribution<int>(0, 19)(random);
    drag_joint(skeleton, local, joint, model[joint].translation);
    EXPECT_TRUE(same(local, before));
  }
}

TEST(Drag, ATargetAtTheCentreChangesNothing) {
  const Skeleton skeleton = small_tree();
  std::vector<Transform> local = skeleton.rest_local;
  drag_joint(skeleton, local, 2, {0.5, 1, 0});
  EXPECT_TRUE(same(local, skeleton.rest_local));
}

TEST(Drag, ARootIsMoved) {
  std::mt19937_64 random(7);
  const Skeleton skeleton = test::random_skeleton(random, 10);
  std::vector<Transform> local = test::random_pose(random, skeleton);
  std::vector<Transform> expected = local;
  expected[0].translation = {3, 4, 5};
  drag_joint(skeleton, local, 0, {3, 4, 5});
  EXPECT_TRUE(same(local, expected));
}

TEST(Drag, ABoneWithoutLengthChangesNothing) {
  Skeleton skeleton = small_tree();
  skeleton.rest_local[2].translation.setZero();
  std::vector<Transform> local = skeleton.rest_local;
  drag_joint(skeleton, local, 2, {3, 4, 5});
  EXPECT_TRUE(same(local, skeleton.rest_local));
}

TEST(DragAlone, MovesTheJointAndNoSibling) {
  std::mt19937_64 random(8);
  for (int round = 0; round < 200; ++round) {
    const Skeleton skeleton = test::random_skeleton(random, 20);
    std::vector<Transform> local = test::random_pose(random, skeleton), dragged = local;
    const std::vector<Transform> before = model_of(skeleton, local);
    const int joint = std::uniform_int_distribution<int>(1, 19)(random), parent = skeleton.parents[joint];
    const Vec3 target = test::random_vector(random);
    drag_joint_alone(skeleton, dragged, joint, target);
    const std::vector<Transform> after = model_of(skeleton, dragged);
    const Vec3 expected = nearest_on_bone_sphere(before[parent].translation, before[joint].translation, target);
    EXPECT_LT((after[joint].translation - expected).norm(), 1e-12);

    // The joint turns as it does when all turn; what does not hang on it keeps its place to the bit.
    std::vector<Transform> together = local;
    drag_joint(skeleton, together, joint, target);
    EXPECT_LT(after[joint].rotation.angularDistance(model_of(skeleton, together)[joint].rotation), 1e-7);
    for (int j = 0; j < 20; ++j) {
      int above = j;
      while (above > joint) above = skeleton.parents[above];
      if (above == joint) continue;
      EXPECT_EQ(after[j].translation, before[j].translation);
      EXPECT_EQ(after[j].rotation.coeffs(), before[j].rotation.coeffs());
    }
  }
}

TEST(DragAlone, BoneLengthsOutlastAThousandDrags) {
  std::mt19937_64 random(9);
  const Skeleton skeleton = test::random_skeleton(random, 40);
  std::vector<Transform> local = skeleton.rest_local;
  for (int i = 0; i < 1000; ++i)
    drag_joint_alone(skeleton, local, std::uniform_int_distribution<int>(1, 39)(random), test::random_vector(random));
  for (int j = 1; j < 40; ++j) {
    EXPECT_NEAR(local[j].translation.norm(), skeleton.rest_local[j].translation.norm(), 1e-13);
    EXPECT_NEAR(local[j].rotation.norm(), 1.0, 1e-14);
  }
}

TEST(DragAlone, NothingToDoChangesNothing) {
  Skeleton skeleton = small_tree();
  std::vector<Transform> local = skeleton.rest_local;
  drag_joint_alone(skeleton, local, 2, model_of(skeleton, local)[2].translation); // there already
  drag_joint_alone(skeleton, local, 2, {0.5, 1, 0});                              // the centre
  EXPECT_TRUE(same(local, skeleton.rest_local));
  skeleton.rest_local[2].translation.setZero();
  local = skeleton.rest_local;
  drag_joint_alone(skeleton, local, 2, {3, 4, 5}); // a bone without length
  EXPECT_TRUE(same(local, skeleton.rest_local));
  drag_joint_alone(skeleton, local, 0, {3, 4, 5}); // a root is moved
  EXPECT_EQ(local[0].translation, Vec3(3, 4, 5));
}

} // namespace
