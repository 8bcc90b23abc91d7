// Numbers over time, and what becomes of them as curves of a node.
#include "rig/import/curves/sampling.h"

#include <gmock/gmock.h>
#include <numbers>
#include <stdexcept>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::rig::import_detail;
using ::testing::ElementsAre;

namespace {

using KeyLaw = ScalarKey::Law;

TEST(ImportCurves, LawsAndSides) {
  const ScalarCurve curve = {{.time = 0, .value = 1, .law = KeyLaw::step},
                             {.time = 1, .value = 4, .law = KeyLaw::step_next},
                             {.time = 2, .value = 2, .law = KeyLaw::linear},
                             {.time = 4, .value = 6, .law = KeyLaw::linear},
                             {.time = 4, .value = -1, .law = KeyLaw::step}};
  EXPECT_EQ(value_at(curve, -1, Side::behind), 1);
  EXPECT_EQ(value_at(curve, 1, Side::before), 1);
  EXPECT_EQ(value_at(curve, 1, Side::behind), 2);
  EXPECT_EQ(value_at(curve, 3, Side::behind), 4);
  EXPECT_EQ(value_at(curve, 4, Side::before), 6);
  EXPECT_EQ(value_at(curve, 4, Side::behind), -1);
  EXPECT_EQ(value_at(curve, 9, Side::before), -1);
  EXPECT_EQ(way_between(curve, 1, 2), 0);
  EXPECT_EQ(way_between(curve, 2, 4), 4);
}

TEST(ImportCurves, HandlesBeyondTheirStretchAreShortenedAlongTheirSlope) {
  ScalarCurve curve = {{.time = 0, .value = 0, .law = KeyLaw::bezier, .leaving = {4, 8}, .arriving = {-3, 1}},
                       {.time = 1, .value = 5}};
  keep_handles_inside(curve);
  EXPECT_EQ(curve[0].leaving.time, 1);
  EXPECT_EQ(curve[0].leaving.value, 2);
  EXPECT_EQ(curve[0].arriving.time, 0);
  EXPECT_EQ(curve[0].arriving.value, 4);
  curve[0].leaving = {-1, 3}; // against the time: no slope could be kept
  curve[0].arriving = {2, 3};
  keep_handles_inside(curve);
  EXPECT_EQ(curve[0].leaving.time, 0);
  EXPECT_EQ(curve[0].arriving.time, 1);
  double last = 0;
  for (int i = 0; i <= 1000; ++i) { // one value at each time, and nowhere a jump
    const double value = value_at(curve, 0.001 * i, Side::before);
    EXPECT_LT(std::abs(value - last), 0.5) << i;
    last = value;
  }
}

TEST(ImportCurves, HandlesAtTheThirdsInSinglePrecisionAreAPolynomial) {
  for (const double start : {0.0, 100.0 / 3, 3600.5}) {
    const double h = 1.0 / 30;
    const auto single = [](double time) { return static_cast<double>(static_cast<float>(time)); };
    const ScalarCurve curve = {{.time = single(start),
                                .value = 0,
                                .law = KeyLaw::bezier,
                                .leaving = {single(start + h / 3), 1},
                                .arriving = {single(start + 2 * h / 3), 2}},
                               {.time = single(start + h), .value = 3}};
    EXPECT_TRUE(is_polynomial(curve, start + 0.5 * h)) << start;
  }
  const ScalarCurve weighted = {
      {.time = 0, .value = 0, .law = KeyLaw::bezier, .leaving = {0.34, 1}, .arriving = {2.0 / 3, 2}},
      {.time = 1, .value = 3}};
  EXPECT_FALSE(is_polynomial(weighted, 0.5));
}

TEST(ImportCurves, SampledCurvesAreAsNearAsAsked) {
  const auto turn = [](double t) { return Quat(Eigen::AngleAxisd(3 * std::sin(2 * t), Vec3(1, 2, 3).normalized())); };
  const RotationCurve curve = sampled(
      {0.0, 5.0}, {}, [&](double time, Side) { return turn(time); }, k_sampled_angle);
  double worst = 0.0;
  for (double t = 0.0; t < 5; t += 0.0007) worst = std::max(worst, value_at(curve, t).angularDistance(turn(t)));
  EXPECT_LT(worst, 1.1 * k_sampled_angle);
  EXPECT_LT(curve.times.size(), 200u);
}

TEST(ImportCurves, WhatRestsIsHeldAndWhatJumpsHasTwoKeys) {
  const auto at = [](double time, Side side) {
    const bool later = time > 2 || (time == 2 && side == Side::behind);
    return Vec3(later ? 5 : 1, 0, 0);
  };
  const VectorCurve curve = sampled({0, 1, 2, 3}, {}, at, 1e-5);
  EXPECT_THAT(curve.times, ElementsAre(0, 2));
  EXPECT_THAT(curve.laws, ElementsAre(Law::step, Law::step));
  const auto sloped = [&](double time, Side side) { return Vec3(at(time, side) + Vec3(0, time, 0)); };
  EXPECT_THAT(sampled({0, 1, 2, 3}, {}, sloped, 1e-5).times, ElementsAre(0, 1, 2, 2, 3));
}

TEST(ImportCurves, WhatComesRoundIsSeen) {
  const auto turn = [](double t) { return Quat(Eigen::AngleAxisd(8 * std::numbers::pi * t, Vec3::UnitX())); };
  const RotationCurve curve = sampled(
      {0, 1}, {cuts_for(8 * std::numbers::pi)}, [&](double time, Side) { return turn(time); }, k_sampled_angle);
  for (double t = 0.0; t < 1; t += 0.003) EXPECT_LT(value_at(curve, t).angularDistance(turn(t)), 1e-9);
  EXPECT_EQ(cuts_for(1e300), static_cast<int>(k_most_pieces));
}

TEST(ImportCurves, TooManyPiecesAreRefused) {
  const auto noise = [](double time, Side) { return Vec3(std::sin(1e9 * time), 0, 0); };
  EXPECT_THROW(sampled({0, 1}, {2'000'000}, noise, 1e-9), std::length_error);
  EXPECT_THROW(sampled({0, 1, 2}, {600'000, 600'000}, noise, 1e-9), std::length_error);
  EXPECT_LT(sampled({0, 1}, {}, noise, 1e-9).times.size(), 70'000u); // halved sixteen times and no more
}

TEST(ImportCurves, PosesOfMaps) {
  bool has_shear = false;
  const Quat turn(Eigen::AngleAxisd(2, Vec3(1, -1, 3).normalized()));
  const Eigen::Affine3d map = Eigen::Translation3d(1, 2, 3) * turn * Eigen::Scaling(2.0, 0.5, 3.0);
  Pose pose = pose_of(map, has_shear);
  EXPECT_FALSE(has_shear);
  EXPECT_LT(pose.rotation.angularDistance(turn), 1e-12);
  EXPECT_LT((pose.scale - Vec3(2, 0.5, 3)).norm(), 1e-12);
  pose = pose_of(Eigen::Affine3d(turn * Eigen::Scaling(-2.0)), has_shear); // mirrored
  EXPECT_FALSE(has_shear);
  EXPECT_LT((pose.rotation.toRotationMatrix() * pose.scale.asDiagonal().toDenseMatrix() + 2.0 * turn.toRotationMatrix())
                .norm(),
            1e-12);
  pose_of(Eigen::Affine3d(Eigen::Scaling(0.0)), has_shear);
  EXPECT_FALSE(has_shear);
  pose_of(Eigen::Affine3d(Eigen::Scaling(1.0, 2.0, 1.0) * turn), has_shear);
  EXPECT_TRUE(has_shear);
}

} // namespace
