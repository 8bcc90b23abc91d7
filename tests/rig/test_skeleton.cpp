#include "rig/error.h"
#include "rig/skeleton.h"
#include "tests/rig/random_skeleton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;

namespace {

const Quat k_quarter_about_z(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));

Skeleton named(std::vector<std::string> names) {
  Skeleton skeleton;
  for (std::string& name : names) {
    skeleton.parents.push_back(skeleton.joint_count() - 1);
    skeleton.names.push_back(std::move(name));
    skeleton.rest_local.emplace_back();
  }
  return skeleton;
}

std::string error_of(const Skeleton& skeleton) {
  try {
    skeleton.check("body.dae");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Skeleton, ForwardKinematicsOfAChainByHand) {
  // Three bones of 1 m along +Y; the first joint stands at (1, 0, 0) and turns by 90 degrees about Z, the second by
  // -90.
  Skeleton skeleton = named({"a", "b", "c", "d"});
  const std::vector<Transform> local = {{k_quarter_about_z, {1, 0, 0}},
                                        {k_quarter_about_z.conjugate(), {0, 1, 0}},
                                        {Quat::Identity(), {0, 1, 0}},
                                        {k_quarter_about_z, {0.5, 0, 2}}};
  std::vector<Transform> model(4);
  model_from_local(skeleton, local, model);
  EXPECT_LT((model[0].translation - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((model[1].translation - Vec3(0, 0, 0)).norm(), 1e-15);
  EXPECT_LT((model[2].translation - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((model[3].translation - Vec3(0.5, 1, 2)).norm(), 1e-15);
  EXPECT_LT(model[2].rotation.angularDistance(Quat::Identity()), 1e-7);
  EXPECT_LT((model[3] * Vec3(1, 0, 0) - Vec3(0.5, 2, 2)).norm(), 1e-15);
}

TEST(Skeleton, RestModelIsTheModelOfTheRestPose) {
  std::mt19937_64 random(1);
  const Skeleton skeleton = test::random_skeleton(random, 30);
  std::vector<Transform> model(30);
  model_from_local(skeleton, skeleton.rest_local, model);
  const std::vector<Transform> rest = rest_model(skeleton);
  for (int j = 0; j < 30; ++j) EXPECT_EQ(model[j].translation, rest[j].translation);
}

TEST(Skeleton, LocalFromModelIsTheInverse) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 20; ++round) {
    Skeleton skeleton = test::random_skeleton(random, 40);
    skeleton.parents[20] = k_no_parent; // two trees
    const std::vector<Transform> local = test::random_pose(random, skeleton);
    std::vector<Transform> model(40), back(40);
    model_from_local(skeleton, local, model);
    local_from_model(skeleton, model, back);
    for (int j = 0; j < 40; ++j) {
      EXPECT_LT((back[j].translation - local[j].translation).norm(), 1e-13);
      EXPECT_LT((back[j].rotation.coeffs() - local[j].rotation.coeffs()).norm(), 1e-13);
    }
  }
}

TEST(Skeleton, NamesWithoutTheirNamespace) {
  EXPECT_EQ(bare_joint_name("Hips"), "Hips");
  EXPECT_EQ(bare_joint_name("mixamorig:Hips"), "Hips");
  EXPECT_EQ(bare_joint_name("a:b:Hips"), "Hips");
  EXPECT_EQ(bare_joint_name("mixamorig_Hips"), "Hips");
  EXPECT_EQ(bare_joint_name("mixamorig1_Hips"), "Hips");
  EXPECT_EQ(bare_joint_name("mixamorig"), "mixamorig");
  EXPECT_EQ(bare_joint_name(""), "");
}

TEST(Skeleton, FindKnowsTheSameJointUnderItsOtherNames) {
  const Skeleton skeleton = named({"mixamorig:Hips", "mixamorig:LeftUpLeg", "Spine"});
  for (const char* name : {"mixamorig:Hips", "Hips", "hips", "mixamorig_Hips", "mixamorig12:HIPS", "mixamorig2_Hips"})
    EXPECT_EQ(skeleton.find(name), 0) << name;
  EXPECT_EQ(skeleton.find("mixamorig:Spine"), 2);
  EXPECT_EQ(skeleton.find("UpLeg"), std::nullopt);
  EXPECT_EQ(skeleton.find("LeftUpLegs"), std::nullopt);
  EXPECT_EQ(skeleton.find(""), std::nullopt);
}

TEST(Skeleton, FindIsExactWhereItCanBeAndElseRefusesToGuess) {
  const Skeleton skeleton = named({"a:Hips", "b:Hips", "hips", "c:Head"});
  EXPECT_EQ(skeleton.find("b:Hips"), 1);
  EXPECT_EQ(skeleton.find("hips"), 2);
  EXPECT_EQ(skeleton.find("Hips"), std::nullopt);
  EXPECT_EQ(skeleton.find("c:Hips"), std::nullopt);
  EXPECT_EQ(skeleton.find("head"), 3);
}

TEST(Skeleton, CheckNamesTheFileAndTheJoint) {
  EXPECT_EQ(error_of(named({"a", "b", "c"})), "");
  EXPECT_EQ(error_of(Skeleton()), "");
  EXPECT_EQ(error_of(named({"a", "b", "a"})),
            "body.dae: joint a: found the name twice, expected every joint name once");
  Skeleton own_parent = named({"a", "b"}), later = named({"a", "b", "c"}), below = named({"a"}), broken = named({"a"});
  own_parent.parents[1] = 1;
  later.parents[1] = 2;
  below.parents[0] = -2;
  broken.rest_local[0].translation.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_of(own_parent), testing::HasSubstr("joint b: found parent 1"));
  EXPECT_THAT(error_of(later), testing::HasSubstr("joint b: found parent 2"));
  EXPECT_THAT(error_of(below), testing::HasSubstr("joint a: found parent -2"));
  EXPECT_THAT(error_of(broken), testing::HasSubstr("joint a: found a non-finite"));
}

} // namespace
