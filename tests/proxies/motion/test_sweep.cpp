// First touches against dense sampling of the step, and the bound below which none is needed.
#include "proxies/motion/sweep.h"

#include "proxies/motion/collider_motion.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/nearest_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <vector>

using namespace tutu;
using namespace tutu::proxies;
using tutu::test::random_point;
using tutu::test::search_point;

namespace {

/// A capsule (every fifth a sphere) that moves and turns by up to `motion` (m) at its ends.
std::pair<Capsule, Capsule> random_moving_capsule(std::mt19937_64& random, double motion, int i) {
  std::uniform_real_distribution<double> radius(0.03, 0.1);
  Capsule start{random_point(random, 0.3), random_point(random, 0.3), radius(random)};
  start.taper = test::random_taper(random, start.radius, i / 7);
  if (i % 5 == 0) start.b = start.a, start.taper = 0.0;
  Capsule end = start;
  end.a += random_point(random, motion);
  end.b = i % 5 == 0 ? end.a : Vec3(end.b + random_point(random, motion));
  return {start, end};
}

struct Sampled {
  double first = 2.0; ///< first time at which the gap is not above 0, by bisection; 2 where it never is
  double least = 1e9; ///< smallest gap seen
};

Sampled sampled(const std::function<double(double)>& gap, int samples) {
  Sampled result;
  double before = 0.0;
  for (int k = 0; k <= samples; ++k) {
    const double t = static_cast<double>(k) / samples, here = gap(t);
    result.least = std::min(result.least, here);
    if (here <= 0.0) {
      double out = before, in = t;
      for (int i = 0; i < 50 && k > 0; ++i) (gap(0.5 * (out + in)) > 0.0 ? out : in) = 0.5 * (out + in);
      result.first = in;
      return result;
    }
    before = t;
  }
  return result;
}

/// What an impact promises about the gap over the step. Returns how early it is.
double expect_promises(bool touches, double time, const std::function<double(double)>& gap, int samples,
                       double sampling, int i) {
  const Sampled truth = sampled(gap, samples);
  if (!touches) {
    EXPECT_GT(truth.least, 0.0) << "missed, case " << i;
    return 0.0;
  }
  EXPECT_TRUE(time >= 0.0 && time <= 1.0) << i;
  EXPECT_LE(gap(time), k_touch) << "too early, case " << i;
  EXPECT_LE(time, truth.first) << "late, case " << i;
  EXPECT_LE(truth.least, k_touch + sampling) << "invented, case " << i;
  return truth.first <= 1.0 ? truth.first - time : 0.0;
}

/// Roughly towards the capsule; every third time at speed, beyond it by up to ten times the way.
Vec3 random_move(std::mt19937_64& random, const Vec3& from, const Capsule& start, int i) {
  std::uniform_real_distribution<double> far(0.0, i % 3 ? 2.0 : 10.0);
  return far(random) * (0.5 * (start.a + start.b) + random_point(random, 0.15) - from);
}

/// How much the gap may dip between samples, m: the relative motion in half of the time between them.
double unseen(const Vec3& move, const Capsule& start, const Capsule& end, int samples) {
  const double limb = std::max((end.a - start.a).norm(), (end.b - start.b).norm());
  return (move.norm() + 2.0 * limb) / samples;
}

struct Share {
  int touches = 0, inside = 0, cases = 0;
  std::vector<double> early;
  void expect_representative() {
    EXPECT_GT(touches, 0.3 * cases);
    EXPECT_LT(touches, 0.7 * cases);
    EXPECT_GT(inside, 0.01 * cases);
    EXPECT_LT(inside, 0.3 * cases);
    std::sort(early.begin(), early.end());
    EXPECT_LE(early[early.size() / 2], 1e-5);
    EXPECT_LE(early[early.size() * 99 / 100], 1e-3); // grazing ones
  }
};

TEST(PointSweep, AgreesWithDenseSampling) {
  std::mt19937_64 random(1);
  Share share;
  for (int i = 0; i < 10000; ++i, ++share.cases) {
    const auto [start, end] = random_moving_capsule(random, i % 3 ? 0.2 : 0.6, i);
    const Vec3 from = random_point(random, 0.3);
    const Vec3 to = from + random_move(random, from, start, i);
    const double offset = i % 2 ? 0.002 : 0.0;
    const auto impact = time_of_impact(from, to, start, end, offset);
    const auto gap = [&, s = start, e = end](double t) {
      return search_point((1 - t) * from + t * to, capsule_at(s, e, t), 30).distance - offset;
    };
    const int samples = 400;
    const double early = expect_promises(impact.has_value(), impact ? impact->time : 0.0, gap, samples,
                                         unseen(to - from, start, end, samples), i);
    if (!impact) continue;
    ++share.touches;
    share.early.push_back(early);
    share.inside += gap(0.0) <= 0.0;
    if (gap(0.0) <= 0.0) {
      EXPECT_EQ(impact->time, 0.0);
    }
    const test::Searched there =
        search_point((1 - impact->time) * from + impact->time * to, capsule_at(start, end, impact->time));
    EXPECT_NEAR(impact->contact.distance, there.distance, 1e-12);
    EXPECT_LE((impact->contact.normal - there.normal).norm(), 1e-9) << i;
  }
  share.expect_representative();
}

template <std::size_t Corners> void expect_feature_sweeps_agree(std::uint64_t seed, int cases, int samples) {
  std::mt19937_64 random(seed);
  Share share;
  for (int i = 0; i < cases; ++i, ++share.cases) {
    const auto [start, end] = random_moving_capsule(random, i % 3 ? 0.2 : 0.6, i);
    std::array<Vec3, Corners> from, to;
    const Vec3 place = random_point(random, 0.45), move = random_move(random, place, start, i);
    for (std::size_t k = 0; k < Corners; ++k) {
      from[k] = place + random_point(random, 0.1);
      to[k] = from[k] + move + random_point(random, 0.1);
    }
    const auto gap = [&, s = start, e = end](double t) {
      const auto now = [&](std::size_t k) { return Vec3((1 - t) * from[k] + t * to[k]); };
      const Capsule capsule = capsule_at(s, e, t);
      if constexpr (Corners == 2) return test::search_edge(now(0), now(1), capsule, 22).distance - 0.001;
      else return test::search_triangle({now(0), now(1), now(2)}, capsule).distance - 0.001;
    };
    const auto impact = time_of_impact(from, to, start, end, 0.001);
    const double early = expect_promises(impact.has_value(), impact ? impact->time : 0.0, gap, samples,
                                         unseen(move, start, end, samples) + 0.3 / samples, i);
    if (!impact) continue;
    ++share.touches;
    share.early.push_back(early);
    share.inside += gap(0.0) <= 0.0;
    if (gap(0.0) <= 0.0) {
      EXPECT_EQ(impact->time, 0.0);
    }
    EXPECT_NEAR(impact->contact.distance, gap(impact->time) + 0.001, 1e-7);
  }
  share.expect_representative();
}

TEST(EdgeSweep, AgreesWithDenseSampling) { expect_feature_sweeps_agree<2>(2, 4000, 200); }
TEST(TriangleSweep, AgreesWithDenseSampling) { expect_feature_sweeps_agree<3>(3, 1000, 60); }

TEST(PointSweep, KnownTimes) {
  const Capsule ball{Vec3::Zero(), Vec3::Zero(), 0.1}, limb{{-1, 0, 0}, {1, 0, 0}, 0.1};
  const auto time = [](const Vec3& from, const Vec3& to, const Capsule& start, const Capsule& end, double offset = 0) {
    const auto impact = time_of_impact(from, to, start, end, offset);
    return impact ? impact->time : -1.0;
  };
  EXPECT_NEAR(time({0, 1, 0}, {0, -1, 0}, limb, limb), 0.45, 1e-6);
  EXPECT_NEAR(time({0, 1, 0}, {0, -1, 0}, limb, limb, 0.1), 0.4, 1e-6);
  EXPECT_NEAR(time({0, 1e4, 0}, {0, -1e4, 0}, ball, ball), 0.5 * (1 - 1e-5), 1e-9); // at speed
  EXPECT_EQ(time({0, 0.05, 0}, {0, 5, 0}, ball, ball), 0.0);                        // inside, on its way out
  EXPECT_EQ(time({0, 0, 0}, {0, 0, 0}, ball, ball), 0.0);
  EXPECT_EQ(time({0, 1, 0}, {0, 1, 0}, ball, ball), -1.0);                    // nothing moves
  EXPECT_EQ(time({0, 1, 0}, {0, 2, 0}, ball, ball), -1.0);                    // away
  EXPECT_EQ(time({0, 1, 0}, {0, 0.1 + 1e-5, 0}, ball, ball), -1.0);           // ends just before
  EXPECT_NEAR(time({0, 1, 0}, {0, 0.1, 0}, ball, ball), 1.0, 2e-6);           // ends on it
  EXPECT_EQ(time({-1, 0.1 + 1e-5, 0}, {1, 0.1 + 1e-5, 0}, ball, ball), -1.0); // grazes past
  EXPECT_NEAR(time({-1, 0.1 - 1e-5, 0}, {1, 0.1 - 1e-5, 0}, ball, ball), 0.5, 1e-3);
  // A limb that turns by a quarter and meets a point that stands still: at 60 degrees of 90, less the radius.
  const Capsule up{{0, -1, 0}, {0, 1, 0}, 0.01};
  const double angle = std::acos(0.5) - std::asin(0.01 / 0.5);
  const Capsule lying{{-1, 0, 0}, {1, 0, 0}, 0.01};
  EXPECT_NEAR(time({0.25, 0.25 * std::sqrt(3.0), 0}, {0.25, 0.25 * std::sqrt(3.0), 0}, lying, up),
              angle / std::acos(0.0), 1e-5);
}

TEST(PointSweep, HoveringIsNotTouching) {
  // 5 um above the surface all the way, while everything moves fast: below, along, and about.
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ(), hover = (0.1 + 5e-6) * Vec3::UnitY();
  const Capsule lying{-x, x, 0.1}, turned{Vec3(-x + 3.0 * z).normalized(), Vec3(x - 3.0 * z).normalized(), 0.1};
  EXPECT_FALSE(time_of_impact(hover - 0.9 * x, hover + 0.9 * x, lying, lying, 0.0));
  EXPECT_FALSE(time_of_impact(hover, hover, lying, turned, 0.0));
  EXPECT_FALSE(time_of_impact(hover - 0.4 * x, hover + 0.4 * z, lying, turned, 0.0));
  const std::array<Vec3, 2> before = {hover - 0.5 * x, hover + 0.5 * x}, after = {hover - 0.5 * z, hover + 0.5 * z};
  EXPECT_FALSE(time_of_impact(before, after, lying, turned, 0.0));
  const std::array<Vec3, 3> low = {before[0], before[1], hover + z}, round = {after[0], after[1], hover - x};
  EXPECT_FALSE(time_of_impact(low, round, lying, turned, 0.0));
  // The same seesaws that do come down.
  const Vec3 sunk = hover - 1e-4 * Vec3::UnitY();
  EXPECT_TRUE(time_of_impact(hover, sunk, lying, turned, 0.0));
  EXPECT_TRUE(time_of_impact(low, {sunk - 0.5 * z, sunk + 0.5 * z, sunk - x}, lying, turned, 0.0));
}

TEST(SafeMotion, BelowItThePushComesOutOnTheSideItCameFrom) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> part(0.0, 0.999), away(0.0, 0.05);
  int pushed = 0;
  for (int i = 0; i < 20000; ++i) {
    Capsule start{random_point(random, 0.3), random_point(random, 0.3), 0.08};
    if (i % 5 == 0) start.b = start.a;
    const double offset = i % 2 ? 0.01 : 0.0, safe = safe_motion(start.radius, offset);
    const test::Searched first = search_point(random_point(random, 0.4), start);
    const Vec3 from = first.cloth - (first.distance - offset - (i % 3 ? away(random) : 0.0)) * first.normal;
    // The point and both ends of the axis share the relative motion; most of it is towards the axis.
    const auto move = [&] {
      return Vec3(0.5 * part(random) * safe * (random_point(random, 0.3) - first.normal).normalized());
    };
    Capsule end = start;
    end.a -= move();
    end.b = i % 5 == 0 ? end.a : Vec3(end.b - move());
    const Vec3 to = from + move();
    const test::Searched last = search_point(to, end);
    if (last.distance >= offset) continue;
    ++pushed;
    // Where the point of the axis was that is nearest at the end.
    const Vec3 before = from - ((1 - last.t) * start.a + last.t * start.b);
    EXPECT_GT(last.normal.dot(before), 0.0) << i;
  }
  EXPECT_GT(pushed, 4000);
}

TEST(SafeMotion, AtItAPointMayComeOutOnTheFarSide) {
  const Capsule ball{Vec3::Zero(), Vec3::Zero(), 0.1};
  const double safe = safe_motion(0.1, 0.02);
  const Vec3 from(0, 0.12, 0), below = from - 0.999 * safe * Vec3::UnitY(), above = from - 1.001 * safe * Vec3::UnitY();
  EXPECT_GT(search_point(below, ball).normal.y(), 0.999);
  EXPECT_LT(search_point(above, ball).normal.y(), -0.999);
}

} // namespace
