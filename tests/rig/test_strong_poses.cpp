#include "rig/character.h"
#include "rig/import/import.h"
#include "rig/strong_poses.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>

namespace tutu::rig {
namespace {

TEST(StrongPoses, NamesTurnOver) {
  EXPECT_EQ(name_on_other_side("mixamorig:LeftArm"), "mixamorig:RightArm");
  EXPECT_EQ(name_on_other_side("B_Knee_Right"), "B_Knee_Left");
  EXPECT_EQ(name_on_other_side("thigh_l"), "thigh_r");
  EXPECT_EQ(name_on_other_side("R_Hand"), "L_Hand");
  EXPECT_EQ(name_on_other_side("Spine1"), "");
  EXPECT_EQ(side_of("clavicle_r"), Side::right);
}

TEST(StrongPoses, AreManyAndKeepBoneLengths) {
  const Skeleton skeleton = import_character(test::source_file("assets/characters/dancer.dae")).character.skeleton;
  const std::vector<NamedPose> poses = strong_poses(skeleton);
  EXPECT_GE(poses.size(), 35u);
  EXPECT_LE(poses.size(), 50u);
  const std::vector<Transform> rest = rest_model(skeleton);
  for (const NamedPose& pose : poses)
    for (int j = 1; j < skeleton.joint_count(); ++j) {
      const int parent = skeleton.parents[j];
      EXPECT_NEAR((pose.model[j].translation - pose.model[parent].translation).norm(),
                  (rest[j].translation - rest[parent].translation).norm(), 1e-9);
    }
}

TEST(StrongPoses, RaiseTheLegThatTheyName) {
  const Skeleton skeleton = import_character(test::source_file("assets/characters/dancer.dae")).character.skeleton;
  const int hip = *skeleton.find("LeftUpLeg"), knee = *skeleton.find("LeftLeg");
  const std::vector<NamedPose> poses = strong_poses(skeleton);
  ASSERT_EQ(poses[1].name, "leg to the front");
  const Vec3 thigh = (poses[1].model[knee].translation - poses[1].model[hip].translation).normalized();
  EXPECT_GT(thigh.z(), 0.95); // 100 degrees from straight down: forward, and a little up
  EXPECT_NEAR(thigh.y(), 0.17, 0.02);
}

TEST(StrongPoses, OnlyRestWithoutNames) {
  Skeleton skeleton;
  skeleton.names = {"bone0", "bone1"};
  skeleton.parents = {-1, 0};
  skeleton.rest_local.resize(2);
  EXPECT_EQ(strong_poses(skeleton).size(), 1u);
}

} // namespace
} // namespace tutu::rig
