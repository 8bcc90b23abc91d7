#include "rig/body_regions.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::rig;

namespace {

Skeleton chain(std::vector<std::string> names) {
  Skeleton skeleton;
  skeleton.names = std::move(names);
  for (int j = 0; j < skeleton.joint_count(); ++j) skeleton.parents.push_back(j - 1);
  skeleton.rest_local.resize(skeleton.names.size());
  return skeleton;
}

TEST(BodyRegions, AreToldByTheNamesOfCommonRigs) {
  using enum BodyRegion;
  const std::vector<std::pair<std::string, BodyRegion>> expected = {{"mixamorig:Hips", torso},
                                                                    {"mixamorig_Spine2", torso},
                                                                    {"LeftShoulder", torso},
                                                                    {"LeftForeArm", arms},
                                                                    {"mixamorig:LeftHandRing1", hands},
                                                                    {"RightUpLeg", legs},
                                                                    {"RightToeBase", feet},
                                                                    {"HeadTop_End", head},
                                                                    {"Bip01 L Calf", legs},
                                                                    {"Bip01 R UpperArm", arms},
                                                                    {"Bip01 L Clavicle", torso},
                                                                    {"Bip01 Neck", head},
                                                                    {"thigh.L", legs},
                                                                    {"upper_arm.R", arms},
                                                                    {"PELVIS", torso},
                                                                    {"left_ankle", feet}};
  for (const auto& [name, region] : expected) EXPECT_EQ(body_regions(chain({name})).front(), region) << name;
}

TEST(BodyRegions, AJointThatSaysNothingIsWhereItsParentIs) {
  using enum BodyRegion;
  EXPECT_EQ(body_regions(chain({"root", "Hand", "bone_7", "bone_8"})), (std::vector{other, hands, hands, hands}));
}

TEST(BodyRegions, TheMainJointHasMostOfTheWeightAtThePoint) {
  Skin skin;
  skin.slot_joint = {2, 0, 2}; // one joint bound in two ways
  skin.inverse_bind.resize(3, Eigen::Affine3d::Identity());
  skin.slots = {0, 1, 2, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  skin.weights = {0.3f, 0.4f, 0.3f, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const Triangle t = {0, 1, 2};
  EXPECT_EQ(main_joint(skin, t, Vec3(1, 0, 0)), 2); // 0.6 in two parts against 0.4
  EXPECT_EQ(main_joint(skin, t, Vec3(0.5, 0.5, 0)), 0);
}

} // namespace
