#include "rig/clip.h"
#include "rig/error.h"
#include "tests/rig/random_skeleton.h"

#include <bit>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

using namespace tutu;
using namespace tutu::rig;
using testing::HasSubstr;

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN(), k_infinity = std::numeric_limits<double>::infinity();

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

bool same_bits(const Transform& a, const Transform& b) {
  bool same = true;
  for (int i = 0; i < 3; ++i) same = same && same_bits(a.translation[i], b.translation[i]);
  for (int i = 0; i < 4; ++i) same = same && same_bits(a.rotation.coeffs()[i], b.rotation.coeffs()[i]);
  return same;
}

Skeleton chain() {
  Skeleton skeleton;
  skeleton.names = {"mixamorig:Hips", "mixamorig:Spine"};
  skeleton.parents = {k_no_parent, 0};
  skeleton.rest_local = {{Quat::Identity(), {0, 1, 0}}, {Quat::Identity(), {0, 0.1, 0}}};
  return skeleton;
}

/// One key a time; the hips stand at height `time` and turn about Y by `time`.
RawClip raw_clip(const std::vector<double>& times, Extrapolation extrapolation) {
  RawClip raw{"dance.json", "dance", extrapolation, {}};
  for (const double time : times) {
    RawClip::Key key{time, "pose", {}};
    key.joints["Hips"] = {Vec3(0, time, 0), Quat(Eigen::AngleAxisd(time, Vec3::UnitY()))};
    raw.keys.push_back(key);
  }
  return raw;
}

Transform hips(const Clip& clip, double time) {
  std::vector<Transform> local(clip.joint_count);
  sample(clip, time, local);
  return local[0];
}

std::string error_of(const RawClip& raw) {
  try {
    build_clip(raw, chain());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Clip, WhatAKeyLeavesOutIsAsAtRest) {
  RawClip raw = raw_clip({0.0, 1.0}, Extrapolation::loop);
  raw.keys[0].joints["Hips"].translation.reset();
  raw.keys[1].joints["Hips"].rotation.reset();
  const Clip clip = build_clip(raw, chain());
  EXPECT_EQ(clip.duration(), 1.0);
  EXPECT_EQ(clip.key(0)[0].translation, Vec3(0, 1, 0));
  EXPECT_EQ(clip.key(1)[0].rotation.coeffs(), Quat::Identity().coeffs());
  EXPECT_EQ(clip.key(1)[1].translation, Vec3(0, 0.1, 0));
}

TEST(Clip, BetweenKeysTranslationsAreLinearAndRotationsNormalisedLinear) {
  std::mt19937_64 random(1);
  const Skeleton skeleton = test::random_skeleton(random, 20);
  const Clip clip = build_clip(test::random_clip(random, skeleton, 5), skeleton);
  std::vector<Transform> local(20);
  std::uniform_real_distribution<double> time(clip.times.front(), clip.times.back());
  for (int round = 0; round < 200; ++round) {
    const double t = time(random);
    sample(clip, t, local);
    int k = 0;
    while (clip.times[k + 1] <= t) ++k;
    const double s = (t - clip.times[k]) / (clip.times[k + 1] - clip.times[k]);
    for (int j = 0; j < 20; ++j) {
      const Transform &a = clip.key(k)[j], &b = clip.key(k + 1)[j];
      EXPECT_LT((local[j].translation - (a.translation + s * (b.translation - a.translation))).norm(), 1e-15);
      const double side = a.rotation.dot(b.rotation) < 0 ? -1.0 : 1.0;
      const Eigen::Vector4d q = ((1 - s) * a.rotation.coeffs() + side * s * b.rotation.coeffs()).normalized();
      EXPECT_LT((local[j].rotation.coeffs() - q).norm(), 1e-14);
    }
  }
}

TEST(Clip, OnAKeyTheSampleIsThatKeyToTheBit) {
  std::mt19937_64 random(2);
  const Skeleton skeleton = test::random_skeleton(random, 20);
  RawClip raw = test::random_clip(random, skeleton, 50);
  for (const Extrapolation extrapolation : {Extrapolation::loop, Extrapolation::clamp}) {
    raw.extrapolation = extrapolation;
    const Clip clip = build_clip(raw, skeleton);
    std::vector<Transform> local(20);
    for (int k = 0; k < 50; ++k) {
      sample(clip, clip.times[k], local);
      for (int j = 0; j < 20; ++j) EXPECT_TRUE(same_bits(local[j], clip.key(k)[j]));
    }
  }
}

TEST(Clip, JointsThatDoNotMoveKeepTheirBits) {
  std::mt19937_64 random(3);
  const Skeleton skeleton = test::random_skeleton(random, 20);
  RawClip raw = test::random_clip(random, skeleton, 2);
  for (int j = 0; j < 19; ++j)
    raw.keys[1].joints["J" + std::to_string(j)] = raw.keys[0].joints["J" + std::to_string(j)];
  const Clip clip = build_clip(raw, skeleton);
  std::vector<Transform> local(20);
  for (double s = 0.0; s < 1.0; s += 0.013) {
    sample(clip, clip.times[0] + s * clip.duration(), local);
    for (int j = 0; j < 19; ++j) EXPECT_TRUE(same_bits(local[j], clip.key(0)[j]));
  }
}

TEST(Clip, LoopWrapsTimeBothWays) {
  const Clip clip = build_clip(raw_clip({0.5, 1.0, 2.5}, Extrapolation::loop), chain());
  for (const double time : {0.625, 0.75, 1.0, 1.25, 2.0, 2.25})
    for (const double laps : {-1e6, -3.0, -1.0, 1.0, 2.0, 1e9})
      EXPECT_TRUE(same_bits(hips(clip, time + 2.0 * laps), hips(clip, time))) << time << " " << laps;
  EXPECT_EQ(hips(clip, 2.5).translation.y(), 2.5); // on the last key: that key
  EXPECT_EQ(hips(clip, 4.5).translation.y(), 0.5); // a lap later the last key is the first one again
  EXPECT_EQ(hips(clip, 0.0).translation.y(), 2.0);
  EXPECT_NEAR(hips(clip, 0.5 - 1e-300).translation.y(), 0.5, 1e-12); // too near the first key to be told from it
  EXPECT_NEAR(hips(clip, 0.5 - 1e-12).translation.y(), 2.5, 1e-9);
}

TEST(Clip, ClampHoldsTheEnds) {
  const Clip clip = build_clip(raw_clip({0.5, 1.0, 2.5}, Extrapolation::clamp), chain());
  for (const double time : {0.5, 0.4999, -1e300, -k_infinity}) EXPECT_EQ(hips(clip, time).translation.y(), 0.5);
  for (const double time : {2.5, 2.5001, 1e300, k_infinity}) EXPECT_EQ(hips(clip, time).translation.y(), 2.5);
}

TEST(Clip, AnyTimeGivesAPoseOfTheClip) {
  for (const Extrapolation extrapolation : {Extrapolation::loop, Extrapolation::clamp}) {
    const Clip clip = build_clip(raw_clip({0.1, 0.2, 0.7}, extrapolation), chain());
    for (const double time : {k_nan, k_infinity, -k_infinity, 1e308, -1e308, 1e17, -1e17, 5e-324}) {
      const Transform pose = hips(clip, time);
      EXPECT_GE(pose.translation.y(), 0.1) << time;
      EXPECT_LE(pose.translation.y(), 0.7) << time;
      EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-15);
    }
  }
}

TEST(Clip, OneKeyIsAlwaysThatKey) {
  for (const Extrapolation extrapolation : {Extrapolation::loop, Extrapolation::clamp}) {
    const Clip clip = build_clip(raw_clip({0.3}, extrapolation), chain());
    for (const double time : {0.0, 0.3, 7.0, -1.0, k_nan, k_infinity})
      EXPECT_TRUE(same_bits(hips(clip, time), clip.key(0)[0])) << time;
  }
}

TEST(Clip, UnusableClipsAreRefusedWithTheirPlace) {
  EXPECT_THAT(error_of(raw_clip({}, Extrapolation::loop)), HasSubstr("dance.json: clip dance: found no keys"));
  EXPECT_THAT(error_of(raw_clip({0, 1, 1}, Extrapolation::loop)),
              HasSubstr("key 2 (pose): found time 1 s after 1 s of the key before, expected strictly rising"));
  EXPECT_THAT(error_of(raw_clip({0, 1, 0.5}, Extrapolation::loop)),
              HasSubstr("key 2 (pose): found time 0.5 s after 1 s"));
  EXPECT_THAT(error_of(raw_clip({k_nan}, Extrapolation::loop)), HasSubstr("key 0 (pose): found time nan"));

  RawClip raw = raw_clip({0, 1}, Extrapolation::loop);
  raw.keys[1].joints["Tail"] = {};
  EXPECT_THAT(error_of(raw), HasSubstr("key 1 (pose), joint Tail: found a joint the skeleton lacks"));
  raw = raw_clip({0, 1}, Extrapolation::loop);
  raw.keys[1].joints["mixamorig:Hips"] = {};
  EXPECT_THAT(error_of(raw), HasSubstr("joint mixamorig:Hips: found the same joint as Hips"));
  raw = raw_clip({0, 1}, Extrapolation::loop);
  raw.keys[1].joints["Hips"].translation->x() = k_infinity;
  EXPECT_THAT(error_of(raw), HasSubstr("joint Hips: found a translation beyond all bounds"));
  raw = raw_clip({0, 1}, Extrapolation::loop);
  raw.keys[1].joints["Hips"].rotation->w() = k_nan;
  EXPECT_THAT(error_of(raw), HasSubstr("a unit quaternion"));
  raw.keys[1].joints["Hips"].rotation->coeffs().setConstant(1.0);
  EXPECT_THAT(error_of(raw), HasSubstr("found a rotation of length 2"));
}

} // namespace
