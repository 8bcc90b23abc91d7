// Motion in channels: each curve by its own keys and law.
#include "rig/channel_clip.h"
#include "rig/error.h"
#include "rig/motion.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>

using namespace tutu;
using namespace tutu::rig;

namespace {

using Vec4 = Eigen::Vector4d;

Quat turn(double angle, const Vec3& axis) { return Quat(Eigen::AngleAxisd(angle, axis.normalized())); }

VectorCurve line(Law law) {
  return {{1.0, 2.0, 4.0}, {Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3(3, 2, 1)}, {law, law, law}, {}, {}};
}

TEST(Curve, BeforeAndBehindItsKeysItIsHeld) {
  for (const Law law : {Law::step, Law::linear}) {
    EXPECT_EQ(value_at(line(law), -5.0), Vec3(0, 0, 0));
    EXPECT_EQ(value_at(line(law), 1.0), Vec3(0, 0, 0));
    EXPECT_EQ(value_at(line(law), 4.0), Vec3(3, 2, 1));
    EXPECT_EQ(value_at(line(law), 9.0), Vec3(3, 2, 1));
    EXPECT_TRUE(value_at(line(law), std::nan("")).allFinite());
  }
}

TEST(Curve, AStepHoldsUpToTheNextKey) {
  EXPECT_EQ(value_at(line(Law::step), std::nextafter(2.0, 0.0)), Vec3(0, 0, 0));
  EXPECT_EQ(value_at(line(Law::step), 2.0), Vec3(1, 2, 3));
  EXPECT_EQ(value_at(line(Law::step), 3.9), Vec3(1, 2, 3));
}

TEST(Curve, LinearIsTheStraightWay) { EXPECT_LT((value_at(line(Law::linear), 2.5) - Vec3(1.5, 2, 2.5)).norm(), 1e-15); }

TEST(Curve, OfTwoKeysAtOneTimeTheSecondCountsFromThereOn) {
  const VectorCurve jump = {{0.0, 1.0, 1.0, 2.0},
                            {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(5, 0, 0), Vec3(6, 0, 0)},
                            {Law::linear, Law::linear, Law::linear, Law::linear},
                            {},
                            {}};
  EXPECT_NEAR(value_at(jump, std::nextafter(1.0, 0.0)).x(), 1.0, 1e-12);
  EXPECT_EQ(value_at(jump, 1.0).x(), 5.0);
  EXPECT_NEAR(value_at(jump, 1.5).x(), 5.5, 1e-15);
}

TEST(Curve, RotationsTurnAtConstantSpeedAlongTheShorterArc) {
  const Quat a = turn(0.2, Vec3(1, 2, 3)), b = a * turn(1.2, Vec3(0, 1, 1));
  for (const double sign : {1.0, -1.0}) {
    const RotationCurve curve = {{0.0, 3.0}, {a.coeffs(), Vec4(sign * b.coeffs())}, {Law::linear, Law::linear}, {}, {}};
    for (const double s : {0.1, 0.25, 0.5, 0.9})
      EXPECT_LT(value_at(curve, 3.0 * s).angularDistance(a * turn(1.2 * s, Vec3(0, 1, 1))), 1e-12) << s;
  }
}

/// glTF 2.0, appendix C.5, written out.
Vec4 cubic_spline(const Vec4& v0, const Vec4& b0, const Vec4& a1, const Vec4& v1, double td, double t) {
  return (2 * t * t * t - 3 * t * t + 1) * v0 + td * (t * t * t - 2 * t * t + t) * b0 +
         (-2 * t * t * t + 3 * t * t) * v1 + td * (t * t * t - t * t) * a1;
}

TEST(Curve, CubicsAreHermiteByComponent) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i) {
    const auto any = [&] { return Vec4(normal(random), normal(random), normal(random), normal(random)); };
    const Vec4 v0 = any().normalized(), v1 = any().normalized(), b0 = any(), a1 = any();
    const RotationCurve rotation = {{1.0, 3.5}, {v0, v1}, {Law::cubic, Law::step}, {b0, any()}, {any(), a1}};
    const VectorCurve vector = {{1.0, 3.5},
                                {v0.head<3>(), v1.head<3>()},
                                {Law::cubic, Law::step},
                                {b0.head<3>(), Vec3::Zero()},
                                {Vec3::Zero(), a1.head<3>()}};
    for (const double s : {0.0, 0.2, 0.5, 0.7}) {
      const Vec4 expected = cubic_spline(v0, b0, a1, v1, 2.5, s);
      EXPECT_LT((value_at(vector, 1.0 + 2.5 * s) - expected.head<3>()).norm(), 1e-12);
      EXPECT_LT((value_at(rotation, 1.0 + 2.5 * s).coeffs() - expected.normalized()).norm(), 1e-12);
    }
  }
}

TEST(Curve, RefusesWhatIsNone) {
  const auto refused = [](auto spoil) {
    VectorCurve curve = line(Law::linear);
    spoil(curve);
    EXPECT_THROW(check(curve, "file", "place"), InputError);
  };
  EXPECT_NO_THROW(check(line(Law::linear), "file", "place"));
  refused([](VectorCurve& c) { c.times[1] = 0.5; });
  refused([](VectorCurve& c) { c.times[1] = std::numeric_limits<double>::infinity(); });
  refused([](VectorCurve& c) { c.values.pop_back(); });
  refused([](VectorCurve& c) { c.laws.pop_back(); });
  refused([](VectorCurve& c) { c.laws[0] = Law::cubic; });
  refused([](VectorCurve& c) { c.values[1].y() = 1e10; });
  RotationCurve long_one = {{0.0}, {Vec4(0, 0, 0, 1.1)}, {Law::step}, {}, {}};
  EXPECT_THROW(check(long_one, "file", "place"), InputError);
}

/// Two joints: the first moves in steps from 1.25 s on, the second does not move.
ChannelClip late() {
  ChannelClip clip;
  clip.name = "late";
  clip.start = 0.0;
  clip.end = 2.25;
  clip.still = {{turn(0.3, Vec3::UnitX()), Vec3(0, 1, 0)}, {turn(0.7, Vec3::UnitY()), Vec3(0, 0.5, 0)}};
  clip.joints = {{0,
                  {{1.25, 2.0}, {Vec3(1, 0, 0), Vec3(2, 0, 0)}, {Law::step, Law::step}, {}, {}},
                  {{0.0, 2.25},
                   {Quat::Identity().coeffs(), turn(1.0, Vec3::UnitZ()).coeffs()},
                   {Law::linear, Law::linear},
                   {},
                   {}}}};
  return clip;
}

TEST(ChannelClip, KeepsTheFilesTimeLine) {
  const ChannelClip clip = late();
  EXPECT_NO_THROW(check(clip));
  std::vector<Transform> local(2);
  sample(clip, 0.0, local);
  EXPECT_EQ(local[0].translation, Vec3(1, 0, 0)) << "before its first key its value holds";
  EXPECT_EQ(local[1].rotation.coeffs(), clip.still[1].rotation.coeffs()) << "what does not move stands still";
  sample(clip, 2.25 + 0.5, local); // loops
  EXPECT_EQ(local[0].translation, Vec3(1, 0, 0));
  EXPECT_NEAR(local[0].rotation.angularDistance(Quat::Identity()), 0.5 / 2.25, 1e-12);
  EXPECT_EQ(key_times(clip), (std::vector<double>{0.0, 1.25, 2.0, 2.25}));
}

TEST(ChannelClip, OfNoLengthIsAPose) {
  ChannelClip clip = late();
  clip.end = 0.0;
  std::vector<Transform> local(2);
  for (const double time : {-1.0, 0.0, 7.0}) {
    sample(clip, time, local);
    EXPECT_EQ(local[0].translation, Vec3(1, 0, 0));
  }
}

TEST(ChannelClip, RefusesJointsThatAreNotThere) {
  ChannelClip clip = late();
  clip.joints[0].joint = 2;
  EXPECT_THROW(check(clip), InputError);
  clip = late();
  clip.joints.push_back(clip.joints[0]);
  EXPECT_THROW(check(clip), InputError);
  clip = late();
  clip.end = -1.0;
  EXPECT_THROW(check(clip), InputError);
}

TEST(Motion, IsEitherKind) {
  Skeleton skeleton;
  skeleton.names = {"a", "b"};
  skeleton.parents = {k_no_parent, 0};
  skeleton.rest_local.resize(2);
  Motion motion = late();
  EXPECT_EQ(motion.duration(), 2.25);
  EXPECT_EQ(motion.joint_count(), 2);
  EXPECT_EQ(first_pose(motion)[0].translation, Vec3(1, 0, 0));
  std::vector<Transform> local(2), model(2), before(2);
  pose_at(motion, skeleton, 1.25, before, model);
  EXPECT_LT((model[1].translation - (before[0] * before[1].translation)).norm(), 1e-15);

  set_interpolation(motion, skeleton, Interpolation::slerp); // who asks for another law gets key poses
  ASSERT_TRUE(std::holds_alternative<Clip>(motion));
  EXPECT_EQ(motion.duration(), 2.25);
  pose_at(motion, skeleton, 1.25, local, model);
  EXPECT_LT(local[0].rotation.angularDistance(before[0].rotation), 1e-12);
  pose_at(motion, skeleton, 1.625, local, model);
  EXPECT_NEAR(local[0].translation.x(), 1.5, 1e-12) << "steps are lines now";
}

} // namespace
