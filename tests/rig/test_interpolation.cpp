#include "rig/clip.h"
#include "rig/interpolation.h"
#include "tests/rig/random_skeleton.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;

namespace {

constexpr double k_pi = std::numbers::pi;

std::vector<Transform> pose_at(const Clip& clip, double time) {
  std::vector<Transform> local(clip.joint_count);
  sample(clip, time, local);
  return local;
}

/// Angular velocity in the turning frame, and linear velocity, from samples at `t` and `t + dt`.
Clip::Velocity velocity_between(const Transform& a, const Transform& b, double dt) {
  return {(b.translation - a.translation) / dt, log_of(a.rotation.conjugate() * b.rotation) / dt};
}

Clip random_cubic(std::mt19937_64& random, const Skeleton& skeleton, int keys, Extrapolation extrapolation) {
  RawClip raw = test::random_clip(random, skeleton, keys);
  raw.extrapolation = extrapolation;
  raw.interpolation = Interpolation::cubic;
  raw.keys.back().joints = raw.keys.front().joints;
  return build_clip(raw, skeleton);
}

/// One joint that turns about `axis` by `angles` and moves along it as far, at `times`.
Clip about_axis(const Vec3& axis, const std::vector<double>& times, const std::vector<double>& angles,
                Extrapolation extrapolation, Interpolation interpolation) {
  Skeleton skeleton;
  skeleton.names = {"J"};
  skeleton.parents = {k_no_parent};
  skeleton.rest_local = {{}};
  RawClip raw{"axis", "axis", extrapolation, {}, interpolation};
  for (std::size_t k = 0; k < times.size(); ++k)
    raw.keys.push_back({times[k], "", {{"J", {Vec3(angles[k] * axis), Quat(Eigen::AngleAxisd(angles[k], axis))}}}});
  return build_clip(raw, skeleton);
}

TEST(Interpolation, ExponentialAndLogarithm) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 500; ++round) {
    const Vec3 axis = test::random_vector(random).normalized();
    const double angle = std::uniform_real_distribution<double>(0.0, 3.14)(random);
    EXPECT_LT((exp_of(angle * axis).coeffs() - Quat(Eigen::AngleAxisd(angle, axis)).coeffs()).norm(), 1e-15);
    EXPECT_LT((log_of(exp_of(angle * axis)) - angle * axis).norm(), 1e-13);
    Quat other = exp_of(angle * axis);
    other.coeffs() = -other.coeffs();
    EXPECT_LT((log_of(other) - angle * axis).norm(), 1e-13); // the same rotation
    for (const double tiny : {0.0, 1e-300, 1e-160, 1e-20, 1e-8})
      EXPECT_LT((log_of(exp_of(tiny * axis)) - tiny * axis).norm(), 1e-15 * tiny + 1e-300);
  }
}

TEST(Interpolation, SlerpTurnsAtConstantSpeedAlongTheShorterArc) {
  std::mt19937_64 random(2);
  const Skeleton skeleton = test::random_skeleton(random, 10);
  RawClip raw = test::random_clip(random, skeleton, 5);
  raw.interpolation = Interpolation::slerp;
  const Clip clip = build_clip(raw, skeleton);
  for (int k = 0; k < 4; ++k) {
    const double h = clip.times[k + 1] - clip.times[k];
    for (const double s : {0.1, 0.25, 0.5, 0.9}) {
      const std::vector<Transform> local = pose_at(clip, clip.times[k] + s * h);
      for (int j = 0; j < 10; ++j) {
        const Transform &a = clip.key(k)[j], &b = clip.key(k + 1)[j];
        const Quat expected = a.rotation * exp_of(s * log_of(a.rotation.conjugate() * b.rotation)); // [Shoemake 1985]
        EXPECT_LT(log_of(expected.conjugate() * local[j].rotation).norm(), 1e-12);
        EXPECT_LT((local[j].translation - (a.translation + s * (b.translation - a.translation))).norm(), 1e-14);
      }
    }
  }
}

TEST(Interpolation, OnAKeyEveryInterpolationGivesThatKeyToTheBit) {
  std::mt19937_64 random(3);
  const Skeleton skeleton = test::random_skeleton(random, 20);
  Clip clip = build_clip(test::random_clip(random, skeleton, 30), skeleton);
  for (const Interpolation interpolation : {Interpolation::nlerp, Interpolation::slerp, Interpolation::cubic}) {
    set_interpolation(clip, interpolation);
    for (int k = 0; k < 30; ++k) {
      const std::vector<Transform> local = pose_at(clip, clip.times[k]);
      for (int j = 0; j < 20; ++j) {
        EXPECT_EQ(local[j].rotation.coeffs(), clip.key(k)[j].rotation.coeffs());
        EXPECT_EQ(local[j].translation, clip.key(k)[j].translation);
      }
    }
  }
}

TEST(Interpolation, CubicVelocityIsContinuousAtKeysAndAcrossTheLoop) {
  std::mt19937_64 random(4);
  double worst = 0.0, worst_turn = 0.0, nlerp_jump = 0.0;
  for (int round = 0; round < 20; ++round) {
    const Skeleton skeleton = test::random_skeleton(random, 10);
    Clip clip = random_cubic(random, skeleton, 8, Extrapolation::loop);
    const auto jump = [&](double time) { // of the extrapolated one-sided differences: errors of second order in dt
      constexpr double k_dt = 1e-5;
      const auto at = [&](int i) { return pose_at(clip, time + i * k_dt); };
      const auto l2 = at(-2), l1 = at(-1), m = at(0), r1 = at(1), r2 = at(2);
      Clip::Velocity most{Vec3::Zero(), Vec3::Zero()};
      for (int j = 0; j < clip.joint_count; ++j) {
        const auto left = velocity_between(l1[j], m[j], k_dt), far_left = velocity_between(l2[j], l1[j], k_dt);
        const auto right = velocity_between(m[j], r1[j], k_dt), far_right = velocity_between(r1[j], r2[j], k_dt);
        const auto at_key = [](const Vec3& near, const Vec3& far) { return Vec3(1.5 * near - 0.5 * far); };
        most.linear = most.linear.cwiseMax(
            (at_key(right.linear, far_right.linear) - at_key(left.linear, far_left.linear)).cwiseAbs());
        most.angular = most.angular.cwiseMax(
            (at_key(right.angular, far_right.angular) - at_key(left.angular, far_left.angular)).cwiseAbs());
      }
      return most;
    };
    for (std::size_t k = 0; k < clip.times.size(); ++k) { // the last key and the first are one, across the loop
      const Clip::Velocity most = jump(clip.times[k] + (k == 0 ? clip.duration() : 0.0));
      worst = std::max(worst, most.linear.maxCoeff());
      worst_turn = std::max(worst_turn, most.angular.maxCoeff());
    }
    set_interpolation(clip, Interpolation::nlerp);
    nlerp_jump = std::max(nlerp_jump, jump(clip.times[3]).angular.maxCoeff());
  }
  std::printf("cubic, 20 random clips: velocity jumps at keys by at most %.1e m/s and %.1e rad/s (nlerp: %.0f rad/s)\n",
              worst, worst_turn, nlerp_jump);
  EXPECT_LT(worst, 1e-5);
  EXPECT_LT(worst_turn, 1e-3); // keys are down to 10 ms apart, at tens of rad/s: second differences, not jumps
  EXPECT_GT(nlerp_jump, 1.0);
}

TEST(Interpolation, CubicHasTheVelocityItSays) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 200; ++round) {
    const Quat a = test::random_rotation(random), b = a * exp_of(test::random_vector(random, 0.5));
    const Vec3 va = test::random_vector(random), vb = test::random_vector(random);
    const double h = std::uniform_real_distribution<double>(0.1, 1.0)(random), ds = 1e-6;
    EXPECT_LT((hermite(a, b, va, vb, h, 0.0).coeffs() - a.coeffs()).norm(), 1e-14);
    EXPECT_LT(log_of(hermite(a, b, va, vb, h, 1.0).conjugate() * b).norm(), 1e-13);
    const Vec3 start = log_of(a.conjugate() * hermite(a, b, va, vb, h, ds)) / (ds * h);
    const Vec3 end = log_of(hermite(a, b, va, vb, h, 1.0 - ds).conjugate() * b) / (ds * h);
    EXPECT_LT((start - va).norm(), 1e-3);
    EXPECT_LT((end - vb).norm(), 1e-3);
  }
}

TEST(Interpolation, CubicNeverOvershoots) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int round = 0; round < 200; ++round) {
    const Vec3 axis = test::random_vector(random).normalized();
    std::vector<double> times = {0.0}, angles = {uniform(random)};
    for (int k = 1; k < 10; ++k) {
      times.push_back(times.back() + 0.01 + std::abs(uniform(random)));
      // Steps of all sizes, some none.
      angles.push_back(k % 4 == 3 ? angles.back() : angles.back() + std::pow(uniform(random), 5));
    }
    const Clip clip =
        about_axis(axis, times, angles, round % 2 ? Extrapolation::loop : Extrapolation::clamp, Interpolation::cubic);
    for (int k = 0; k < 9; ++k) {
      double before = angles[k];
      const double direction = angles[k + 1] >= angles[k] ? 1.0 : -1.0;
      for (int i = 1; i < 50; ++i) {
        const Transform pose = pose_at(clip, times[k] + (times[k + 1] - times[k]) * i / 50.0)[0];
        const double angle = angles[k] + log_of(Quat(Eigen::AngleAxisd(-angles[k], axis)) * pose.rotation).dot(axis);
        EXPECT_LT(log_of(pose.rotation).cross(axis).norm(), 1e-13); // about that axis alone
        EXPECT_GE(direction * (angle - before), -1e-13);
        EXPECT_GE(direction * (angles[k + 1] - angle), -1e-13);
        EXPECT_NEAR(pose.translation.dot(axis), angle, 1e-12); // the rotation's curve is the number's
        before = angle;
      }
    }
  }
}

TEST(Interpolation, CubicTranslationsAreMonotoneByComponent) {
  std::mt19937_64 random(7);
  const Skeleton skeleton = test::random_skeleton(random, 10);
  const Clip clip = random_cubic(random, skeleton, 12, Extrapolation::loop);
  for (int k = 0; k < 11; ++k) {
    std::vector<Transform> before = pose_at(clip, clip.times[k]);
    for (int i = 1; i <= 40; ++i) {
      const std::vector<Transform> now =
          pose_at(clip, i == 40 ? clip.times[k + 1] : clip.times[k] + (clip.times[k + 1] - clip.times[k]) * i / 40.0);
      for (int j = 0; j < 10; ++j) {
        const Vec3 whole = clip.key(k + 1)[j].translation - clip.key(k)[j].translation;
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_GE(std::copysign(1.0, whole[axis]) * (now[j].translation - before[j].translation)[axis], -1e-15);
      }
      before = now;
    }
  }
}

TEST(Interpolation, CubicEndsOfAClampedClipAreAtRest) {
  const Clip clip = about_axis(Vec3::UnitX(), {0, 1, 2}, {0, 1, 2}, Extrapolation::clamp, Interpolation::cubic);
  EXPECT_EQ(clip.velocities.front().angular, Vec3(0, 0, 0));
  EXPECT_EQ(clip.velocities.back().linear, Vec3(0, 0, 0));
  EXPECT_NEAR(clip.velocities[1].angular.x(), 1.0, 1e-15);
}

TEST(Interpolation, CubicStaysFiniteBetweenKeysThatAreAsNearAsNumbersCanBe) {
  for (const Extrapolation extrapolation : {Extrapolation::loop, Extrapolation::clamp})
    for (const double gap : {5e-324, 1e-310, 1e-300, 1e-12}) {
      const Clip clip = about_axis(Vec3::UnitY(), {0.0, gap, 2 * gap, 1.0}, {0.0, 1.0, 2.5, 0.0}, extrapolation,
                                   Interpolation::cubic);
      for (const double time : {0.0, 0.5 * gap, gap, 1.5 * gap, 2 * gap, 0.1, 0.9})
        EXPECT_TRUE(is_finite(pose_at(clip, time)[0])) << gap << " at " << time;
    }
}

TEST(Interpolation, CubicTurnsByHalfTurnsWithoutTrouble) {
  const Clip clip =
      about_axis(Vec3::UnitY(), {0, 1, 2, 3}, {0, k_pi, 0, k_pi}, Extrapolation::clamp, Interpolation::cubic);
  for (double t = 0.0; t <= 3.0; t += 0.01) EXPECT_NEAR(pose_at(clip, t)[0].rotation.norm(), 1.0, 1e-14);
}

TEST(Interpolation, CubicJointsThatDoNotMoveKeepTheirBits) {
  std::mt19937_64 random(8);
  const Skeleton skeleton = test::random_skeleton(random, 20);
  RawClip raw = test::random_clip(random, skeleton, 4);
  raw.interpolation = Interpolation::cubic;
  for (const char* joint : {"J3", "J7"}) {
    raw.keys[2].joints[joint] = raw.keys[1].joints[joint];
    const Clip clip = build_clip(raw, skeleton);
    const int j = *skeleton.find(joint);
    for (double s = 0.0; s < 1.0; s += 0.013) {
      const Transform pose = pose_at(clip, clip.times[1] + s * (clip.times[2] - clip.times[1]))[j];
      EXPECT_EQ(pose.rotation.coeffs(), clip.key(1)[j].rotation.coeffs());
      EXPECT_EQ(pose.translation, clip.key(1)[j].translation);
    }
  }
}

} // namespace
