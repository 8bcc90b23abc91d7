#include "rig/error.h"
#include "rig/flight.h"
#include "tests/rig/random_skeleton.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::rig;
using testing::HasSubstr;

namespace {

Skeleton hips_and_spine() {
  Skeleton skeleton;
  skeleton.names = {"Hips", "Spine"};
  skeleton.parents = {k_no_parent, 0};
  skeleton.rest_local = {{Quat::Identity(), {0, 1, 0}}, {Quat::Identity(), {0, 0.1, 0}}};
  return skeleton;
}

/// Stand, crouch, take off, two poses in the air (the second the higher), land lower and 0.9 m ahead, stand.
RawClip jump(Interpolation interpolation = Interpolation::cubic) {
  RawClip raw{"jump.json", "jump", Extrapolation::clamp, {}, interpolation};
  const auto add = [&](double time, const Vec3& hips, bool airborne) {
    RawClip::Key key{time, "", {{"Hips", {hips, Quat(Eigen::AngleAxisd(0.3 * time, Vec3::UnitY()))}}}, airborne};
    raw.keys.push_back(key);
  };
  add(0.0, {0, 1, 0}, false);
  add(0.4, {0, 0.7, 0}, false);
  add(0.6, {0, 1.1, 0.1}, false);
  add(0.7, {0, 1.3, 0.2}, true);
  add(1.0, {0, 1.55, 0.5}, true);
  add(1.4, {0.3, 0.9, 1.0}, false);
  add(2.0, {0.3, 1, 1.0}, false);
  return raw;
}

Vec3 hips(const Clip& clip, double time) {
  std::vector<Transform> local(clip.joint_count);
  sample(clip, time, local);
  return local[0].translation;
}

std::string error_of(const RawClip& raw) {
  try {
    build_clip(raw, hips_and_spine());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Flight, TheHeightDecidesTheTimeInTheAir) {
  const Clip clip = build_clip(jump(), hips_and_spine());
  const double up = std::sqrt(2 * 0.45 / k_gravity), down = std::sqrt(2 * 0.65 / k_gravity);
  EXPECT_EQ(clip.times[2], 0.6);
  EXPECT_NEAR(clip.times[3], 0.6 + up / 4, 1e-15); // as before, a quarter of the way up in time
  EXPECT_NEAR(clip.times[4], 0.6 + up, 1e-15);
  EXPECT_NEAR(clip.times[5], 0.6 + up + down, 1e-15);
  EXPECT_NEAR(clip.times[6], 0.6 + up + down + 0.6, 1e-15); // later keys keep their distance
  EXPECT_NEAR(clip.key(4)[0].translation.y(), 1.55, 1e-15); // the top is as high as it was drawn
}

TEST(Flight, GravityIsTheOnlyAccelerationInTheAir) {
  for (const Interpolation interpolation : {Interpolation::nlerp, Interpolation::slerp, Interpolation::cubic}) {
    const Clip clip = build_clip(jump(interpolation), hips_and_spine());
    const double start = clip.times[2], end = clip.times[5], h = 0.02;
    double worst = 0.0;
    for (double t = start + h; t <= end - h; t += 0.003) { // across keys too
      const Vec3 acceleration = (hips(clip, t - h) - 2.0 * hips(clip, t) + hips(clip, t + h)) / (h * h);
      worst = std::max(worst, (acceleration + Vec3(0, k_gravity, 0)).norm());
    }
    std::printf("flight, %s: gravity within %.1e m/s2\n",
                std::string(k_interpolation_names[static_cast<int>(interpolation)]).c_str(), worst);
    EXPECT_LT(worst, 1e-6);
  }
}

TEST(Flight, CubicTakesOffAndLandsWithoutAJumpInVelocity) {
  const Clip clip = build_clip(jump(), hips_and_spine());
  double worst = 0.0;
  for (const int k : {2, 3, 4, 5}) {
    const double t = clip.times[k], h = 1e-5;
    const Vec3 left = (3 * hips(clip, t) - 4 * hips(clip, t - h) + hips(clip, t - 2 * h)) / (2 * h);
    const Vec3 right = (-3 * hips(clip, t) + 4 * hips(clip, t + h) - hips(clip, t + 2 * h)) / (2 * h);
    worst = std::max(worst, (left - right).norm());
  }
  std::printf("flight, cubic: velocity jumps by at most %.1e m/s\n", worst);
  EXPECT_LT(worst, 1e-6);
}

TEST(Flight, WhatIsAFlightAlreadyStays) {
  Clip clip = build_clip(jump(), hips_and_spine());
  const Clip before = clip;
  make_flights(clip, "");
  for (std::size_t k = 0; k < clip.times.size(); ++k) {
    EXPECT_NEAR(clip.times[k], before.times[k], 1e-14);
    EXPECT_LT((clip.key(static_cast<int>(k))[0].translation - before.key(static_cast<int>(k))[0].translation).norm(),
              1e-14);
  }
}

TEST(Flight, ACharacterOfHalfTheHeightIsInTheAirForLess) {
  Skeleton half = hips_and_spine();
  for (Transform& joint : half.rest_local) joint.translation *= 0.5;
  const Clip clip = build_clip(jump(), hips_and_spine()), small = retarget(clip, hips_and_spine(), half, nullptr);
  EXPECT_NEAR((small.times[5] - small.times[2]) / (clip.times[5] - clip.times[2]), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(small.key(4)[0].translation.y(), 0.5 * clip.key(4)[0].translation.y(), 1e-12);
  EXPECT_EQ(small.interpolation, Interpolation::cubic);
}

TEST(Flight, WhatCannotFlyIsRefusedWithItsPlace) {
  RawClip raw = jump();
  raw.keys.front().airborne = true;
  EXPECT_THAT(error_of(raw), HasSubstr("jump.json: clip jump, key 0: found a clip that begins or ends in the air"));
  raw = jump();
  raw.keys.back().airborne = true;
  EXPECT_THAT(error_of(raw), HasSubstr("key 6"));
  raw = jump();
  raw.keys[3].airborne = raw.keys[4].airborne = false;
  raw.keys[1].airborne = true; // the crouch
  EXPECT_THAT(error_of(raw), HasSubstr("key 1: found an airborne root that is not above"));
}

TEST(Flight, AJumpThatIsOverAtOnceIsRefused) {
  RawClip raw{"hop.json", "hop", Extrapolation::clamp, {}, Interpolation::cubic};
  const auto add = [&](double time, double height, bool airborne) {
    raw.keys.push_back({time, "", {{"Hips", {Vec3(0, height, 0), std::nullopt}}}, airborne});
  };
  add(1, 0, false);
  add(2, 1e-33, true); // 3e-17 s, which is nothing beside 1 s
  add(3, 0, false);
  add(4, 0.1, false);
  EXPECT_THAT(error_of(raw),
              HasSubstr("hop.json: clip hop, key 1: found a time that its jumps put on that of the key"));
  raw.keys[1].joints["Hips"].translation = Vec3(0, 1e-20, 0);
  EXPECT_EQ(error_of(raw), "");
}

} // namespace
