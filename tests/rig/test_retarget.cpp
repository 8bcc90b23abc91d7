#include "rig/clip.h"
#include "rig/error.h"
#include "tests/rig/random_skeleton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;

namespace {

struct Joint {
  const char* name;
  int parent;
  Vec3 position; // model space, m
};

/// A skeleton at rest with these joint positions and all joint frames along the axes.
Skeleton skeleton_of(const std::vector<Joint>& joints) {
  Skeleton skeleton;
  for (const Joint& joint : joints) {
    skeleton.names.emplace_back(joint.name);
    skeleton.parents.push_back(joint.parent);
    const Vec3 origin = joint.parent == k_no_parent ? Vec3(Vec3::Zero()) : joints[joint.parent].position;
    skeleton.rest_local.push_back({Quat::Identity(), joint.position - origin});
  }
  return skeleton;
}

/// A T-pose: arms along X, with a hand of two fingers on the left.
std::vector<Joint> dancer() {
  return {{"Hips", -1, {0, 1, 0}},
          {"Spine", 0, {0, 1.2, 0}},
          {"Neck", 1, {0, 1.45, 0}},
          {"Head", 2, {0, 1.6, 0}},
          {"LeftArm", 1, {0.15, 1.4, 0}},
          {"LeftForeArm", 4, {0.42, 1.4, 0}},
          {"LeftHand", 5, {0.67, 1.4, 0}},
          {"LeftIndex", 6, {0.75, 1.4, 0.03}},
          {"LeftThumb", 6, {0.72, 1.4, 0.06}},
          {"RightArm", 1, {-0.15, 1.4, 0}},
          {"RightForeArm", 9, {-0.42, 1.4, 0}},
          {"LeftUpLeg", 0, {0.1, 0.95, 0}},
          {"LeftLeg", 11, {0.1, 0.5, 0.02}},
          {"LeftFoot", 12, {0.1, 0.08, 0}}};
}

/// The same rest positions with every joint frame turned.
Skeleton with_turned_frames(const Skeleton& skeleton, std::mt19937_64& random) {
  std::vector<Transform> model = rest_model(skeleton);
  for (Transform& joint : model) joint.rotation = joint.rotation * test::random_rotation(random);
  Skeleton turned = skeleton;
  local_from_model(turned, model, turned.rest_local);
  return turned;
}

/// Rotations on every joint, a journey of the first.
RawClip moving_clip(std::mt19937_64& random, const Skeleton& skeleton, int keys) {
  RawClip clip = test::random_clip(random, skeleton, keys);
  for (RawClip::Key& key : clip.keys) {
    for (auto& [name, joint] : key.joints) joint.translation.reset();
    key.joints[skeleton.names[0]].translation = skeleton.rest_local[0].translation + test::random_vector(random, 0.3);
  }
  return clip;
}

std::vector<Transform> model_of(const Skeleton& skeleton, const Clip& clip, int key) {
  std::vector<Transform> model(skeleton.joint_count());
  model_from_local(skeleton, clip.key(key), model);
  return model;
}

TEST(Retarget, OntoItselfIsIdentity) {
  std::mt19937_64 random(1);
  const Skeleton skeleton = test::random_skeleton(random, 30);
  RawClip raw = moving_clip(random, skeleton, 6);
  raw.extrapolation = Extrapolation::clamp;
  const Clip clip = build_clip(raw, skeleton);
  std::vector<std::string> unmatched = {"left over"};
  const Clip same = retarget(clip, skeleton, skeleton, &unmatched);
  EXPECT_TRUE(unmatched.empty());
  EXPECT_EQ(same.times, clip.times);
  EXPECT_EQ(same.name, clip.name);
  EXPECT_EQ(same.extrapolation, Extrapolation::clamp);
  ASSERT_EQ(same.local.size(), clip.local.size());
  for (std::size_t i = 0; i < clip.local.size(); ++i) {
    EXPECT_LT((same.local[i].translation - clip.local[i].translation).norm(), 1e-12);
    EXPECT_LT(same.local[i].rotation.angularDistance(clip.local[i].rotation), 1e-7);
  }
}

TEST(Retarget, OtherJointFramesOfTheSameShapeGiveTheSamePositions) {
  std::mt19937_64 random(2);
  const Skeleton source = with_turned_frames(skeleton_of(dancer()), random),
                 target = with_turned_frames(source, random);
  const Clip clip = build_clip(moving_clip(random, source, 6), source);
  const Clip result = retarget(clip, source, target, nullptr);
  for (int k = 0; k < 6; ++k) {
    const auto expected = model_of(source, clip, k), found = model_of(target, result, k);
    for (int j = 0; j < source.joint_count(); ++j)
      EXPECT_LT((found[j].translation - expected[j].translation).norm(), 1e-12) << source.names[j];
  }
}

TEST(Retarget, OrderAndNamespaceOfJointsDoNotMatter) {
  std::mt19937_64 random(3);
  const Skeleton source = skeleton_of(dancer());
  std::vector<Joint> joints = dancer(); // Hips, then the leg, then the rest
  std::rotate(joints.begin() + 1, joints.begin() + 11, joints.end());
  for (std::size_t j = 1; j < joints.size(); ++j)
    if (joints[j].parent > 0) joints[j].parent = joints[j].parent >= 11 ? joints[j].parent - 10 : joints[j].parent + 3;
  Skeleton target = skeleton_of(joints);
  for (std::string& name : target.names) name = "mixamorig:" + name;
  target.check("");
  const Clip clip = build_clip(moving_clip(random, source, 3), source);
  const Clip result = retarget(clip, source, target, nullptr);
  for (int k = 0; k < 3; ++k) {
    const auto expected = model_of(source, clip, k), found = model_of(target, result, k);
    for (int j = 0; j < source.joint_count(); ++j)
      EXPECT_LT((found[*target.find(source.names[j])].translation - expected[j].translation).norm(), 1e-12);
  }
}

TEST(Retarget, AnAPoseFollowsTheArmsOfATPose) {
  std::mt19937_64 random(4);
  const Skeleton source = skeleton_of(dancer());
  std::vector<Joint> lowered = dancer(); // the left arm, with its hand, 50 degrees down about its joint
  const Quat down(Eigen::AngleAxisd(-50.0 * std::numbers::pi / 180, Vec3::UnitZ()));
  for (int j = 5; j <= 8; ++j)
    lowered[j].position = lowered[4].position + down * (lowered[j].position - lowered[4].position);
  const Skeleton target = with_turned_frames(skeleton_of(lowered), random);

  RawClip raw = moving_clip(random, source, 5);
  raw.keys[0].joints.clear(); // the source at rest: the target stands in the T-pose too
  const Clip clip = build_clip(raw, source);
  const Clip result = retarget(clip, source, target, nullptr);
  for (int k = 0; k < 5; ++k) {
    const auto expected = model_of(source, clip, k), found = model_of(target, result, k);
    for (int j = 0; j < source.joint_count(); ++j) // even the fingers: the hand follows the forearm's turn
      EXPECT_LT((found[j].translation - expected[j].translation).norm(), 1e-12) << source.names[j];
  }
}

TEST(Retarget, ATallerSkeletonMovesInProportion) {
  std::mt19937_64 random(5);
  const Skeleton source = skeleton_of(dancer());
  std::vector<Joint> taller = dancer();
  for (Joint& joint : taller) joint.position *= 1.3;
  const Skeleton target = with_turned_frames(skeleton_of(taller), random);
  const Clip clip = build_clip(moving_clip(random, source, 4), source);
  const Clip result = retarget(clip, source, target, nullptr);
  for (int k = 0; k < 4; ++k) {
    const auto expected = model_of(source, clip, k), found = model_of(target, result, k);
    for (int j = 0; j < source.joint_count(); ++j)
      EXPECT_LT((found[j].translation - 1.3 * expected[j].translation).norm(), 1e-12);
  }
}

TEST(Retarget, ARootOnTheGroundTravelsAsFarAsTheSource) {
  const Skeleton source = skeleton_of({{"Root", -1, {0, 0, 0}}, {"Hips", 0, {0, 1, 0}}});
  const Skeleton target = skeleton_of({{"Root", -1, {0, 0, 0}}, {"Hips", 0, {0, 2, 0}}});
  RawClip raw;
  raw.keys.push_back({0.0, "", {{"Root", {Vec3(3, 0.5, -1), {}}}}});
  const Clip result = retarget(build_clip(raw, source), source, target, nullptr);
  EXPECT_LT((result.local[0].translation - Vec3(3, 0.5, -1)).norm(), 1e-15);
  EXPECT_LT((result.local[1].translation - Vec3(0, 2, 0)).norm(), 1e-15);
}

TEST(Retarget, JointsWithoutAPartnerKeepTheirRestAndAreTold) {
  std::mt19937_64 random(6);
  std::vector<Joint> joints = dancer();
  joints[5].name = "Elbow"; // source and target differ in one joint inside a chain
  const Skeleton source = skeleton_of(dancer()), target = with_turned_frames(skeleton_of(joints), random);
  const Clip clip = build_clip(moving_clip(random, source, 3), source);
  std::vector<std::string> unmatched;
  const Clip result = retarget(clip, source, target, &unmatched);
  EXPECT_THAT(unmatched, testing::ElementsAre("LeftForeArm"));
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(result.key(k)[5].rotation.coeffs(), target.rest_local[5].rotation.coeffs());
    EXPECT_EQ(result.key(k)[5].translation, target.rest_local[5].translation);
    // Orientations of paired joints follow the source even below the one that does not.
    const auto from = model_of(source, clip, k), found = model_of(target, result, k), rest = rest_model(target);
    EXPECT_LT((from[6].rotation * rest[6].rotation).angularDistance(found[6].rotation), 1e-7);
  }
}

TEST(Retarget, NothingInCommonIsRefused) {
  const Skeleton source = skeleton_of({{"a", -1, {0, 0, 0}}}), target = skeleton_of({{"b", -1, {0, 0, 0}}});
  RawClip raw;
  raw.name = "waltz";
  raw.keys.emplace_back();
  EXPECT_THROW(retarget(build_clip(raw, source), source, target, nullptr), InputError);
}

} // namespace
