#include "rig/math.h"

#include <gtest/gtest.h>
#include <numbers>
#include <random>

using namespace tutu;

namespace {

Quat random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  return Quat(gauss(random), gauss(random), gauss(random), gauss(random)).normalized();
}

TEST(Math, NlerpIsTheClosedFormInThePlaneOfRotation) {
  // About one axis, nlerp between 0 and phi at s turns by 2 atan2(s sin(phi/2), (1-s) + s cos(phi/2)).
  const double phi = 2.1;
  for (double s = 0.0; s <= 1.0; s += 0.125) {
    const Quat q = nlerp(Quat::Identity(), Quat(Eigen::AngleAxisd(phi, Vec3::UnitY())), s);
    const double expected = 2.0 * std::atan2(s * std::sin(phi / 2), (1.0 - s) + s * std::cos(phi / 2));
    EXPECT_NEAR(2.0 * std::atan2(q.y(), q.w()), expected, 1e-14);
    EXPECT_NEAR(q.norm(), 1.0, 1e-15);
  }
}

TEST(Math, NlerpTakesTheShorterArc) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Quat a = random_rotation(random), b = random_rotation(random);
    Quat minus_b;
    minus_b.coeffs() = -b.coeffs();
    const Quat half = nlerp(a, b, 0.5), other = nlerp(a, minus_b, 0.5);
    EXPECT_LE(a.angularDistance(half), std::numbers::pi / 2 + 1e-12);
    EXPECT_LT(half.angularDistance(other), 1e-7);
  }
}

TEST(Math, RotationBetweenTakesOneDirectionToTheOther) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> gauss;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a(gauss(random), gauss(random), gauss(random)), b(gauss(random), gauss(random), gauss(random));
    EXPECT_LT((rotation_between(a, b) * a.normalized() - b.normalized()).norm(), 1e-12);
    EXPECT_LT((rotation_between(a, -a) * a.normalized() + a.normalized()).norm(), 1e-12);
    EXPECT_NEAR(rotation_between(a, a).w(), 1.0, 1e-15);
  }
  EXPECT_EQ(rotation_between(Vec3::Zero(), Vec3::UnitX()).w(), 1.0);
  // Nearly opposite: still a unit quaternion that does the job.
  const Vec3 almost = (-Vec3::UnitX() + 1e-5 * Vec3::UnitY()).normalized();
  EXPECT_LT((rotation_between(Vec3::UnitX(), almost) * Vec3::UnitX() - almost).norm(), 1e-9);
}

TEST(Math, TransformsComposeAndInvert) {
  std::mt19937_64 random(3);
  const Transform a{random_rotation(random), {1, 2, 3}}, b{random_rotation(random), {-1, 0.5, 2}};
  const Vec3 p(0.3, -0.2, 0.7);
  EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-14);
  EXPECT_LT((a.inverse() * (a * p) - p).norm(), 1e-14);
}

} // namespace
