#include "rig/ik.h"
#include "tests/rig/random_skeleton.h"

#include <gtest/gtest.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr Limb k_leg{1, 3, 4};

/// Hips, hip, a twist joint on the way, knee, foot, toe: thigh and shin of about 0.4 m, frames turned at random.
Skeleton leg(std::mt19937_64& random) {
  Skeleton skeleton;
  skeleton.names = {"hips", "hip", "twist", "knee", "foot", "toe"};
  skeleton.parents = {k_no_parent, 0, 1, 2, 3, 4};
  for (int j = 0; j < 6; ++j)
    skeleton.rest_local.push_back({test::random_rotation(random), 0.2 * test::random_vector(random).normalized()});
  skeleton.rest_local[4].translation *= std::uniform_real_distribution<double>(1.2, 2.0)(random);
  return skeleton;
}

/// Straight down from the hip at height 1: thigh and shin 0.5 m, all frames the model's.
Skeleton straight_leg() {
  Skeleton skeleton;
  skeleton.names = {"hips", "hip", "knee", "foot"};
  skeleton.parents = {k_no_parent, 0, 1, 2};
  skeleton.rest_local = {{Quat::Identity(), {0, 1.1, 0}},
                         {Quat::Identity(), {0, -0.1, 0}},
                         {Quat::Identity(), {0, -0.5, 0}},
                         {Quat::Identity(), {0, -0.5, 0}}};
  return skeleton;
}
constexpr Limb k_straight{1, 2, 3};

/// A chain of `bones` bones of 0.1 m along +Y, all frames the model's.
Skeleton straight_chain(int bones) {
  Skeleton skeleton;
  for (int j = 0; j <= bones; ++j) {
    skeleton.names.push_back("J" + std::to_string(j));
    skeleton.parents.push_back(j - 1);
    skeleton.rest_local.push_back({Quat::Identity(), j == 0 ? Vec3::Zero() : Vec3(0, 0.1, 0)});
  }
  return skeleton;
}

std::vector<int> all_joints(const Skeleton& skeleton) {
  std::vector<int> joints(skeleton.joint_count());
  for (int j = 0; j < skeleton.joint_count(); ++j) joints[j] = j;
  return joints;
}

Vec3 at(const Skeleton& skeleton, const std::vector<Transform>& local, int joint) {
  return model_of_joint(skeleton, local, joint).translation;
}

double angle_of(const Quat& rotation) { return 2.0 * std::atan2(rotation.vec().norm(), std::abs(rotation.w())); }

TEST(IkLimb, ReachesExactlyOnThePolesSide) {
  std::mt19937_64 random(1);
  int in_reach = 0;
  double worst = 0.0;
  for (int round = 0; round < 1000; ++round) {
    const Skeleton skeleton = leg(random);
    std::vector<Transform> local = test::random_pose(random, skeleton);
    const std::vector<Transform> before = local;
    const Vec3 a = at(skeleton, local, 1), b = at(skeleton, local, 3), c = at(skeleton, local, 4);
    const double upper = (b - a).norm(), lower = (c - b).norm();
    const Vec3 target = a + test::random_vector(random, 0.25), pole = a + test::random_vector(random);
    const double error = solve_limb(skeleton, local, k_leg, target, pole), distance = (target - a).norm();
    const Vec3 knee = at(skeleton, local, 3), end = at(skeleton, local, 4), along = (target - a).normalized();
    EXPECT_NEAR(error, (end - target).norm(), 1e-15);
    EXPECT_NEAR((knee - a).norm(), upper, 1e-14);
    EXPECT_NEAR((end - knee).norm(), lower, 1e-14);
    const bool reachable = distance < upper + lower && distance > std::abs(upper - lower);
    in_reach += reachable;
    // Out of reach the error is what is missing, and nothing else: the end is on the line to the target.
    const double missing = std::max({0.0, distance - upper - lower, std::abs(upper - lower) - distance});
    EXPECT_NEAR(error, missing, 1e-12);
    worst = std::max(worst, std::abs(error - missing));
    EXPECT_LT((end - a).cross(along).norm(), 1e-7);
    // The knee lies in the half plane that ends in the line to the target and goes through the pole.
    const Vec3 side = (pole - a) - (pole - a).dot(along) * along, off = (knee - a) - (knee - a).dot(along) * along;
    EXPECT_GE(side.dot(off), -1e-9);
    EXPECT_LT(side.cross(off).norm(), 1e-7 * side.norm());
    for (const int joint : {0, 2, 4, 5}) EXPECT_EQ(local[joint].rotation.coeffs(), before[joint].rotation.coeffs());
    for (int joint = 0; joint < 6; ++joint) EXPECT_EQ(local[joint].translation, before[joint].translation);
  }
  EXPECT_GT(in_reach, 300);
  EXPECT_LT(in_reach, 800);
  RecordProperty("worst_error_m", std::to_string(worst));
  std::printf("solve_limb, 1000 random limbs: worst error beyond what is missing %.2e m\n", worst);
}

TEST(IkLimb, ABentKneeStaysAHinge) {
  std::mt19937_64 random(2);
  const Skeleton skeleton = straight_leg();
  const Limb knee{1, 2, 3, Vec3::UnitX()};
  std::vector<Transform> local = skeleton.rest_local;
  int straight = 0;
  for (int round = 0; round < 300; ++round) {
    const Vec3 target = Vec3(0, 0.4, 0) + test::random_vector(random, 0.15), pole = test::random_vector(random);
    straight += solve_limb(skeleton, local, knee, target, pole) > 0.0;
    // About +X alone, and never the other way: the foot goes back.
    EXPECT_LT(local[2].rotation.vec().tail<2>().norm(), 1e-9);
    EXPECT_GE(local[2].rotation.x() * local[2].rotation.w(), -1e-9);
  }
  EXPECT_GT(straight, 1); // and does not forget its hinge where it is stretched out
}

TEST(IkLimb, AStraightLimbBendsTowardsThePole) {
  const Skeleton skeleton = straight_leg();
  std::vector<Transform> local = skeleton.rest_local;
  const Vec3 target(0, 0.4, 0); // on the line itself
  EXPECT_LT(solve_limb(skeleton, local, k_straight, target, {0, 0.5, 5}), 1e-15);
  EXPECT_LT((at(skeleton, local, 2) - Vec3(0, 0.7, 0.4)).norm(), 1e-14); // 3-4-5
  // The pole on the line says nothing: the knee keeps its side.
  EXPECT_LT(solve_limb(skeleton, local, k_straight, {0, 0.2, 0}, {0, -3, 0}), 1e-15);
  EXPECT_LT((at(skeleton, local, 2) - Vec3(0, 0.6, 0.3)).norm(), 1e-14);
  // A straight limb and a pole on the line: some side, but there.
  local = skeleton.rest_local;
  EXPECT_LT(solve_limb(skeleton, local, k_straight, target, {0, -3, 0}), 1e-15);
}

TEST(IkLimb, OutOfReachItPointsThereAndStraight) {
  const Skeleton skeleton = straight_leg();
  std::vector<Transform> local = skeleton.rest_local;
  EXPECT_NEAR(solve_limb(skeleton, local, k_straight, {3, 1, 4}, {0, 1, 5}), 4.0, 1e-14);
  EXPECT_LT((at(skeleton, local, 3) - Vec3(0.6, 1, 0.8)).norm(), 1e-14);
  EXPECT_LT((at(skeleton, local, 2) - Vec3(0.3, 1, 0.4)).norm(), 1e-14);
  // On the hip itself: thigh and shin fold up.
  EXPECT_LT(solve_limb(skeleton, local, k_straight, {0, 1, 0}, {0, 1, 5}), 1e-14);
}

TEST(IkLimit, SplitsIntoSwingAndTwist) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(0.0, 1.0);
  int free = 0;
  for (int round = 0; round < 1000; ++round) {
    const Quat rest = test::random_rotation(random), local = test::random_rotation(random);
    const Vec3 axis = test::random_vector(random).normalized();
    const JointLimit limit{0, axis, 3.1 * angle(random), -3.1 * angle(random), 3.1 * angle(random)};
    const Quat result = limited(local, rest, limit);
    const Quat away = rest.conjugate() * result;
    const double swing = std::acos(std::clamp(axis.dot(away * axis), -1.0, 1.0));
    EXPECT_LE(swing, limit.most_swing + 1e-7);
    const Quat twist = rotation_between(away * axis, axis) * away; // what is left without the smallest swing
    double about = 2.0 * std::atan2(twist.vec().dot(axis), twist.w());
    about = std::remainder(about, 2.0 * k_pi);
    EXPECT_LE(about, limit.most_twist + 1e-7);
    EXPECT_GE(about, limit.least_twist - 1e-7);
    const bool same = result.coeffs() == local.coeffs();
    free += same;
    EXPECT_LT(angle_of(limited(result, rest, limit).conjugate() * result), 1e-7); // what is within stays
  }
  EXPECT_GT(free, 100);
  EXPECT_LT(free, 900);
}

TEST(IkLimit, AHingeStopsAtItsEnd) {
  const JointLimit knee{2, Vec3::UnitX(), 0.0, 0.0, 2.0};
  const Quat rest = Quat::Identity();
  const auto about_x = [](double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitX())); };
  EXPECT_EQ(limited(about_x(1.0), rest, knee).coeffs(), about_x(1.0).coeffs());
  EXPECT_LT(angle_of(limited(about_x(2.5), rest, knee).conjugate() * about_x(2.0)), 1e-14);
  EXPECT_LT(angle_of(limited(about_x(-0.5), rest, knee)), 1e-14);
  EXPECT_LT(angle_of(limited(Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ())), rest, knee)), 1e-14);

  // A leg that would have to fold further than its knee lets it: short of the target, and told so.
  const Skeleton skeleton = straight_leg();
  std::vector<Transform> local = skeleton.rest_local;
  const double error = solve_limb(skeleton, local, k_straight, {0, 0.9, 0}, {0, 0.5, 5}, std::span(&knee, 1));
  const double reached = 2.0 * 0.5 * std::cos(1.0); // of a knee bent by 2 rad
  EXPECT_NEAR((at(skeleton, local, 3) - Vec3(0, 1, 0)).norm(), reached, 1e-12);
  EXPECT_GT(error, 0.3);
}

TEST(IkFoot, APinnedFootStaysWhileTheBodyMoves) {
  std::mt19937_64 random(4);
  const Skeleton skeleton = straight_leg();
  std::vector<Transform> local = skeleton.rest_local;
  local[1].rotation = Quat(Eigen::AngleAxisd(-0.5, Vec3::UnitX()));
  local[2].rotation = Quat(Eigen::AngleAxisd(0.9, Vec3::UnitX()));
  local[3].rotation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY())) * Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX()));
  const FootPin pin = pin_to_ground(skeleton, local, k_straight, 0.05);
  EXPECT_NEAR(pin.model_from_foot.translation.y(), 0.05, 1e-15); // at rest the foot is at height 0
  EXPECT_EQ(pin.model_from_foot.translation.x(), at(skeleton, local, 3).x());
  EXPECT_LT((pin.model_from_foot.rotation * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-14); // the sole is flat

  for (int round = 0; round < 200; ++round) {
    local[0].translation = Vec3(0, 0.95, 0) + test::random_vector(random, 0.04);
    local[0].rotation = nlerp(Quat::Identity(), test::random_rotation(random), 0.1);
    const double reach = (pin.model_from_foot.translation - at(skeleton, local, 1)).norm();
    const double error = hold_foot(skeleton, local, pin, {0, 0.5, 5});
    EXPECT_NEAR(error, std::max(0.0, reach - 1.0), 1e-12);
    const Transform foot = model_of_joint(skeleton, local, 3);
    EXPECT_LT(angle_of(foot.rotation.conjugate() * pin.model_from_foot.rotation), 1e-7);
  }
}

TEST(IkChain, ReachesWithinItsTolerance) {
  std::mt19937_64 random(5);
  double worst = 0.0;
  for (int round = 0; round < 200; ++round) {
    const int bones = std::uniform_int_distribution<int>(3, 10)(random);
    const Skeleton skeleton = straight_chain(bones);
    std::vector<Transform> local = test::random_pose(random, skeleton);
    const std::vector<int> joints = all_joints(skeleton);
    // Up to 90 % of the reach; nearer to full stretch the method is slow.
    const Vec3 target = test::random_vector(random).normalized() * 0.1 * bones *
                        std::uniform_real_distribution<double>(0.1, 0.9)(random);
    const double error = solve_chain(skeleton, local, joints, target);
    EXPECT_NEAR(error, (at(skeleton, local, bones) - target).norm(), 1e-15);
    worst = std::max(worst, error);
    for (int j = 1; j <= bones; ++j) EXPECT_EQ(local[j].translation, skeleton.rest_local[j].translation);
  }
  EXPECT_LT(worst, 1e-7);
  std::printf("solve_chain, 200 random chains to 90 %% of their reach: worst error %.2e m\n", worst);
}

TEST(IkChain, OutOfReachItIsStraightTowardsTheTarget) {
  std::mt19937_64 random(6);
  for (int round = 0; round < 100; ++round) {
    const Skeleton skeleton = straight_chain(5);
    std::vector<Transform> local = test::random_pose(random, skeleton);
    const Vec3 along = test::random_vector(random).normalized();
    EXPECT_NEAR(solve_chain(skeleton, local, all_joints(skeleton), 0.8 * along), 0.3, 1e-12);
    for (int j = 0; j <= 5; ++j) EXPECT_LT((at(skeleton, local, j) - 0.1 * j * along).norm(), 1e-12);
  }
}

TEST(IkChain, AStraightChainBendsTheWayItIsTold) {
  const Skeleton skeleton = straight_chain(6);
  for (const Vec3& bend : {Vec3(1, 0, 0), Vec3(0, 0, -2), Vec3(0, 7, 0)}) {
    std::vector<Transform> local = skeleton.rest_local;
    ChainOptions options;
    options.bend = bend;
    EXPECT_LT(solve_chain(skeleton, local, all_joints(skeleton), {0, 0.3, 0}, {}, options), 1e-7);
    if (bend.y() == 0.0) {
      EXPECT_GT(at(skeleton, local, 3).dot(bend.normalized()), 0.05);
    }
  }
}

TEST(IkChain, LimitsHoldInTheResult) {
  std::mt19937_64 random(7);
  int reached = 0;
  for (int round = 0; round < 100; ++round) {
    const Skeleton skeleton = straight_chain(8);
    std::vector<Transform> local = skeleton.rest_local;
    std::vector<JointLimit> limits;
    for (int j = 0; j < 8; ++j) limits.push_back({j, Vec3::UnitY(), 0.5, -0.3, 0.3});
    const Vec3 target = Vec3(0, 0.5, 0) + test::random_vector(random, 0.2);
    const double before = (at(skeleton, local, 8) - target).norm();
    const double error = solve_chain(skeleton, local, all_joints(skeleton), target, limits);
    EXPECT_LE(error, before);
    reached += error < 1e-6;
    for (int j = 0; j < 8; ++j)
      EXPECT_LE(std::acos(std::min(1.0, (local[j].rotation * Vec3::UnitY()).y())), 0.5 + 1e-7);
  }
  std::printf("solve_chain, 8 joints of 0.5 rad: %d of 100 targets reached\n", reached);
  EXPECT_GT(reached, 30);
}

TEST(IkChain, WhatIsThereAlreadyKeepsItsBits) {
  std::mt19937_64 random(8);
  const Skeleton skeleton = straight_chain(5);
  std::vector<Transform> local = test::random_pose(random, skeleton);
  const std::vector<Transform> before = local;
  EXPECT_LT(solve_chain(skeleton, local, all_joints(skeleton), at(skeleton, local, 5)), 1e-15);
  for (int j = 0; j <= 5; ++j) EXPECT_EQ(local[j].rotation.coeffs(), before[j].rotation.coeffs());
}

} // namespace
