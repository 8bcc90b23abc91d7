#include "cloth/air/wind.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::cloth;

namespace {

TEST(Wind, WithoutGustsIsSteady) {
  const Wind wind{{1, 2, 3}};
  EXPECT_FALSE(wind.is_still());
  EXPECT_TRUE(Wind{}.is_still());
  for (const double time : {0.0, 1e-3, 7.5, 1e6}) EXPECT_EQ(wind_at(wind, time), wind.velocity);
}

TEST(Wind, GustsHaveTheStatedDeviationAboutTheSteadyWind) {
  const Wind wind{{4, 0, -1}, Gusts{1.5, 0.8, 3}};
  constexpr int k_count = 400000;
  Vec3 mean = Vec3::Zero(), squares = Vec3::Zero(), products = Vec3::Zero();
  double most = 0.0;
  for (int k = 0; k < k_count; ++k) {
    const Vec3 gust = wind_at(wind, 0.037 * k) - wind.velocity;
    mean += gust / k_count;
    squares += gust.cwiseAbs2() / k_count;
    products += Vec3(gust.x() * gust.y(), gust.y() * gust.z(), gust.z() * gust.x()) / k_count;
    most = std::max(most, gust.cwiseAbs().maxCoeff());
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis], 0.0, 0.04);
    EXPECT_NEAR(std::sqrt(squares[axis]), 1.5, 0.03);
    EXPECT_NEAR(products[axis], 0.0, 0.07) << "components are independent";
  }
  EXPECT_GT(most, 2.0 * 1.5);
  EXPECT_LT(most, 2.6 * 1.5);
}

TEST(Wind, GustsAreSmoothAndAsLongAsTheirPeriod) {
  const auto roughness = [](double period) { // mean square of the acceleration
    const Wind wind{{}, Gusts{1.0, period, 5}};
    double sum = 0.0;
    for (int k = 0; k < 20000; ++k) {
      const double time = 0.01 * period * k, step = 1e-4 * period;
      const Vec3 rise = (wind_at(wind, time + step) - wind_at(wind, time)) / step;
      sum += rise.squaredNorm() / 20000;
      // The spline's second derivative is below 2, its knots' noise 1: no jump, also at knots.
      const Vec3 turn = wind_at(wind, time + step) - 2.0 * wind_at(wind, time) + wind_at(wind, time - step);
      EXPECT_LT(turn.norm() / (step * step), 20.0 / (period * period)) << time;
    }
    return sum;
  };
  EXPECT_NEAR(roughness(4.0) * 16.0, roughness(1.0), 1e-6);
}

TEST(Wind, ASeedIsOneWind) {
  const Wind wind{{}, Gusts{1.0, 1.0, 1}}, other{{}, Gusts{1.0, 1.0, 2}};
  int differ = 0;
  for (int k = -50; k < 50; ++k) {
    EXPECT_EQ(wind_at(wind, 0.3 * k), wind_at(wind, 0.3 * k));
    differ += (wind_at(wind, 0.3 * k) - wind_at(other, 0.3 * k)).norm() > 0.1;
  }
  EXPECT_GT(differ, 90);
}

/// On this machine as on the one that wrote them down.
TEST(Wind, HasTheseBits) {
  const Wind wind{{1.0, 0.0, -0.5}, Gusts{0.7, 0.9, 12345}};
  EXPECT_EQ(wind_at(wind, 0), Vec3(0.53134435719413964, 0.38130618390189536, -0.12547347902906325));
  EXPECT_EQ(wind_at(wind, 1.37), Vec3(0.79553716242922712, -0.61739195195970509, 0.68562378055676909));
  EXPECT_EQ(wind_at(wind, -7.2), Vec3(1.2024158270213137, 0.0014118610409626891, -1.0369948133245059));
}

} // namespace
