// Coulomb's law on positions, by what it says.
#include "cloth/contact/coulomb.h"

#include "tests/support/collider_scenes.h"

#include <gtest/gtest.h>

using namespace tutu;
using tutu::test::random_point;

namespace {

TEST(Coulomb, SticksUpToTheLimitAndSlidesBeyond) {
  std::mt19937_64 random(1);
  int stuck = 0;
  constexpr int k_cases = 2000;
  for (int i = 0; i < k_cases; ++i) {
    const Vec3 n = random_point(random, 1.0).normalized(), start = random_point(random, 1.0);
    const Vec3 slip = random_point(random, 0.01), moved = start + slip;
    const double most = std::uniform_real_distribution<double>(0.0, 0.02)(random);
    const Vec3 left = cloth::rubbed(moved, slip, n, most) - start, taken = slip - left;
    EXPECT_NEAR(left.dot(n), slip.dot(n), 1e-15) << "what is along the normal is left alone";
    EXPECT_LE(taken.norm(), most + 1e-15);
    const Vec3 left_across = left - left.dot(n) * n;
    if (left_across.norm() < 1e-15) ++stuck;
    else EXPECT_NEAR(taken.dot(left_across.normalized()), most, 1e-14) << "against the slip, by all there is";
  }
  EXPECT_GT(stuck, 0.3 * k_cases);
  EXPECT_LT(stuck, 0.8 * k_cases);
}

TEST(Coulomb, NothingToTakeIsNothingTaken) {
  const Vec3 x(1, 2, 3), n = Vec3::UnitY();
  EXPECT_EQ(cloth::rubbed(x, Vec3::Zero(), n, 0.0), x);
  EXPECT_EQ(cloth::rubbed(x, 0.5 * n, n, 0.1), x);
  EXPECT_EQ(cloth::rubbed(x, Vec3::UnitX(), n, 0.0), x);
}

} // namespace
