#include "rig/error.h"
#include "rig/io/bvh.h"
#include "rig/io/file_io.h"
#include "rig/mannequin/mannequin.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;
using testing::HasSubstr;

namespace {

/// Two bones along +Y, 100 units high with the end site; the second joint's channels are in another order.
const char* const k_take = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Chest
  {
    OFFSET 0 40 0
    CHANNELS 3 Xrotation Yrotation Zrotation
    End Site
    {
      OFFSET 0 60.0 0
    }
  }
}
MOTION
Frames: 3
Frame Time: .25
1 50 2   0 0 0   0 0 0
1 60 2   90 0 0   0 0 +9E1
5 70 2   10 20 30   10 20 30
)";

struct Take {
  std::filesystem::path folder = test::scratch_folder(), file = folder / "take.bvh";
  explicit Take(const std::string& text) { write_file(file, text); }
  ~Take() { std::filesystem::remove_all(folder); }
};

std::string error_of(const std::string& text, const BvhOptions& options = {}) {
  const Take take(text);
  try {
    read_bvh(take.file, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = k_take;
  return text.replace(text.find(from), from.size(), to);
}

Quat about(int axis, double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vec3::Unit(axis)));
}

TEST(Bvh, ReadsSkeletonAndMotion) {
  const Take take(k_take);
  const Mocap mocap = read_bvh(take.file);
  EXPECT_THAT(mocap.skeleton.names, testing::ElementsAre("Hips", "Chest"));
  EXPECT_THAT(mocap.skeleton.parents, testing::ElementsAre(k_no_parent, 0));
  EXPECT_THAT(mocap.clip.times, testing::ElementsAre(0.0, 0.25, 0.5));
  EXPECT_EQ(mocap.clip.extrapolation, Extrapolation::clamp);
  const double metres = k_bvh_stature / 100.0;
  EXPECT_LT((mocap.skeleton.rest_local[1].translation - Vec3(0, 40 * metres, 0)).norm(), 1e-15);
  EXPECT_LT((mocap.clip.key(2)[0].translation - metres * Vec3(5, 70, 2)).norm(), 1e-15);
  // The channels from left to right.
  const Quat hips = about(2, 10) * about(1, 20) * about(0, 30), chest = about(0, 10) * about(1, 20) * about(2, 30);
  EXPECT_LT((mocap.clip.key(2)[0].rotation.coeffs() - hips.coeffs()).norm(), 1e-15);
  EXPECT_LT((mocap.clip.key(2)[1].rotation.coeffs() - chest.coeffs()).norm(), 1e-15);
  std::vector<Transform> model(2);
  model_from_local(mocap.skeleton, mocap.clip.key(1), model);
  EXPECT_LT((model[1].translation - metres * Vec3(1 - 40, 60, 2)).norm(), 1e-14);
  EXPECT_EQ(mocap.skeleton.rest_local[0].translation, Vec3(0, 0, 0)); // the hips are the lowest point here
}

TEST(Bvh, AFrameCanBeTheRestPoseAndTheMotionBeginLater) {
  const Take take(k_take);
  const Mocap mocap = read_bvh(take.file, {.rest_frame = 0, .from = 0.2, .to = 0.4});
  EXPECT_THAT(mocap.clip.times, testing::ElementsAre(0.0));
  const double metres = k_bvh_stature / 100.0;
  EXPECT_LT((mocap.skeleton.rest_local[0].translation - metres * Vec3(1, 50, 2)).norm(), 1e-15);
  EXPECT_LT((mocap.clip.key(0)[0].translation - metres * Vec3(1, 60, 2)).norm(), 1e-15);
}

TEST(Bvh, OnACharacterItTravelsByRestHeights) {
  const Take take(k_take);
  Mocap mocap = read_bvh(take.file, {.rest_frame = 0, .from = 0.0, .to = {}});
  Skeleton target;
  target.names = {"Pelvis", "Chest", "(Chest)"};
  target.parents = {k_no_parent, 0, 0};
  target.rest_local = {{Quat::Identity(), {0, 1, 0}}, {Quat::Identity(), {0, 0.3, 0}}, {Quat::Identity(), {0, 0, 1}}};
  rename_joints(mocap.skeleton, {{"Hips", "Pelvis"}}, "take.bvh");
  std::vector<std::string> unmatched;
  const Clip clip = retarget(mocap.clip, mocap.skeleton, target, &unmatched);
  EXPECT_TRUE(unmatched.empty());
  // Ten units up from a rest height of fifty, on one of 1 m.
  EXPECT_LT((clip.key(1)[0].translation - Vec3(0, 1.2, 0)).norm(), 1e-14);
  EXPECT_LT((clip.key(1)[0].rotation.coeffs() - about(2, 90).coeffs()).norm(), 1e-14);

  rename_joints(mocap.skeleton, {{"Chest", std::nullopt}}, "take.bvh");
  EXPECT_EQ(mocap.skeleton.names[1], "(Chest)");
  EXPECT_THROW(rename_joints(mocap.skeleton, {{"Tail", "Chest"}}, "take.bvh"), InputError);
  EXPECT_THROW(rename_joints(mocap.skeleton, {{"(Chest)", "Pelvis"}}, "take.bvh"), InputError);
}

TEST(Bvh, WhatIsMalformedIsToldWithItsLine) {
  EXPECT_THAT(error_of(""), HasSubstr("found the end of the file, expected HIERARCHY"));
  EXPECT_THAT(error_of(replaced("Yrotation", "Wrotation")), HasSubstr("line 5: found \"Wrotation\""));
  EXPECT_THAT(error_of(replaced("OFFSET 0 40 0", "OFFSET 0 x 0")), HasSubstr("line 8: found \"x\", expected a finite"));
  EXPECT_THAT(error_of(replaced("CHANNELS 3", "CHANNELS 7")), HasSubstr("line 9"));
  EXPECT_THAT(error_of(replaced("Frames: 3", "Frames: 4")), HasSubstr("the end of the file"));
  EXPECT_THAT(error_of(replaced("Frames: 3", "Frames: 2")), HasSubstr("more numbers"));
  EXPECT_THAT(error_of(replaced("Frames: 3", "Frames: -1")), HasSubstr("line 17"));
  EXPECT_THAT(error_of(replaced("Frames: 3", "Frames: 0")),
              HasSubstr("line 17: found no frames, expected at least one"));
  EXPECT_THAT(error_of(replaced(".25", "0")), HasSubstr("a time above 0"));
  EXPECT_THAT(error_of(replaced("5 70", "nan 70")), HasSubstr("line 21"));
  EXPECT_THAT(error_of(k_take, {.rest_frame = 3, .from = 0.0, .to = {}}), HasSubstr("the rest frame 3"));
  EXPECT_THAT(error_of(k_take, {.rest_frame = {}, .from = 9.0, .to = {}}), HasSubstr("0.75"));
  const std::string whole = k_take;
  for (std::size_t length = 0; length + 2 < whole.size(); length += 7)
    EXPECT_NE(error_of(whole.substr(0, length)), "") << length; // never a crash, never half a take
}

TEST(Bvh, FramesThatNeedNoNumbersAreRefusedHoweverMany) {
  EXPECT_THAT(error_of("HIERARCHY ROOT A { OFFSET 0 1 0 CHANNELS 0 JOINT B { OFFSET 0 1 0 CHANNELS 0 } }\n"
                       "MOTION Frames: 10000000 Frame Time: 0.1"),
              HasSubstr("take.bvh: line 1: found a skeleton without channels, expected one that moves"));
}

TEST(Bvh, ASkeletonOfNearlyNoHeightIsRefusedBeforeItsTravelIsBeyondAllBounds) {
  const auto take = [](const char* height, const char* travel) {
    return std::string("HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xposition End Site { OFFSET 0 ") + height +
           " 0 } }\nMOTION Frames: 1 Frame Time: 0.1 " + travel;
  };
  EXPECT_EQ(error_of(take("0.001", "1000")), "");
  for (const char* travel : {"1e9", "0"})
    EXPECT_THAT(error_of(take("1e-310", travel)), HasSubstr("expected one that stands along +Y")) << travel;
  EXPECT_THAT(error_of(take("1e-300", "-1e9")), HasSubstr("expected one that stands along +Y"));
}

TEST(Bvh, ACarnegieMellonTakeOnTheMannequin) {
  Mocap take = read_bvh(test::assimp_model("BVH/01_01.bvh"), {.rest_frame = 0, .from = 1.0 / 120.0, .to = 12.0});
  EXPECT_EQ(take.skeleton.joint_count(), 31);
  EXPECT_NEAR(take.clip.duration(), 12.0, 0.02);
  rename_joints(take.skeleton,
                {{"LowerBack", "Spine"},
                 {"Spine", "Spine1"},
                 {"Spine1", "Spine2"},
                 {"LeftShoulder", std::nullopt},
                 {"RightShoulder", std::nullopt},
                 {"LeftToeBase", std::nullopt},
                 {"RightToeBase", std::nullopt}},
                "01_01.bvh");
  const Skeleton target = make_mannequin().skeleton;
  const Clip clip = retarget(take.clip, take.skeleton, target, nullptr);
  std::vector<Transform> source_model(take.skeleton.joint_count()), model(target.joint_count());
  double worst = 0.0, lowest = 1.0, highest_low = 0.0;
  for (int k = 0; k < static_cast<int>(clip.times.size()); k += 7) {
    model_from_local(take.skeleton, take.clip.key(k), source_model);
    model_from_local(target, clip.key(k), model);
    const auto way = [](const Skeleton& skeleton, const std::vector<Transform>& joints, const char* a, const char* b) {
      return Vec3((joints[*skeleton.find(b)].translation - joints[*skeleton.find(a)].translation).normalized());
    };
    for (const auto& [a, b] : {std::pair{"LeftUpLeg", "LeftLeg"},
                               {"RightLeg", "RightFoot"},
                               {"LeftArm", "LeftForeArm"},
                               {"RightForeArm", "RightHand"}})
      worst = std::max(worst, (way(target, model, a, b) - way(take.skeleton, source_model, a, b)).norm());
    const double low = std::min(model[*target.find("LeftToeBase")].translation.y(),
                                model[*target.find("RightToeBase")].translation.y());
    lowest = std::min(lowest, low);
    highest_low = std::max(highest_low, low);
  }
  std::printf("bones point as the actor's within %.1e; the lower toe is %.0f to %.0f mm high\n", worst, 1e3 * lowest,
              1e3 * highest_low);
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(lowest, -0.1);
}

} // namespace
