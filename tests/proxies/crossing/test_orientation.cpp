// The predicates against long integers, where rounding alone would say anything.
#include "proxies/crossing/orientation.h"
#include "proxies/crossing/segment_triangle.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

using namespace tutu;
using namespace tutu::proxies;

namespace {

__extension__ typedef __int128 Int128; // not of the standard, but of every compiler this is built by

using Point = std::array<std::int64_t, 3>; ///< |x| <= 2^52

/// Whole numbers of up to 190 bits, as c[k] 2^(27 k).
struct Wide {
  std::array<Int128, 4> c = {};

  void add_product(std::int64_t a, std::int64_t b, std::int64_t d, int sign) {
    const auto split = [](std::int64_t x) { return std::array<Int128, 2>{x & ((1 << 27) - 1), x >> 27}; };
    const auto u = split(a), v = split(b), w = split(d);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 2; ++k) c[i + j + k] += sign * u[i] * v[j] * w[k];
  }
  int sign() {
    for (int k = 0; k < 3; ++k) {
      c[k + 1] += c[k] >> 27;
      c[k] &= (1 << 27) - 1;
    }
    if (c[3] != 0) return c[3] > 0 ? 1 : -1;
    return c[0] != 0 || c[1] != 0 || c[2] != 0;
  }
};

int whole_orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<Point, 3> u;
  for (int k = 0; k < 3; ++k) u[0][k] = b[k] - a[k], u[1][k] = c[k] - a[k], u[2][k] = d[k] - a[k];
  Wide sum;
  for (int k = 0; k < 3; ++k) {
    sum.add_product(u[0][k], u[1][(k + 1) % 3], u[2][(k + 2) % 3], 1);
    sum.add_product(u[0][k], u[1][(k + 2) % 3], u[2][(k + 1) % 3], -1);
  }
  return sum.sign();
}

Vec3 scaled(const Point& p, const std::array<int, 3>& exponents) {
  Vec3 x;
  for (int k = 0; k < 3; ++k) x[k] = std::ldexp(static_cast<double>(p[k]), exponents[k]);
  return x;
}

TEST(Orientation, AgreesWithLongIntegersWhereNearlyDegenerate) {
  std::mt19937_64 random(3);
  int flat = 0, misjudged = 0;
  constexpr int k_trials = 2000000;
  for (int trial = 0; trial < k_trials; ++trial) {
    // d in the plane of a, b, c up to a few units in the last place.
    const int bits = static_cast<int>(random() % 49) + 3;
    const std::int64_t limit = std::int64_t{1} << bits;
    const auto coordinate = [&] { return static_cast<std::int64_t>(random() % (2 * limit)) - limit; };
    const auto point = [&] { return Point{coordinate(), coordinate(), coordinate()}; };
    const Point a = point(), b = point(), c = point();
    const double s = static_cast<double>(random() % 9) / 8.0, t = static_cast<double>(random() % 9) / 8.0 * (1.0 - s);
    const auto noise = static_cast<std::int64_t>(random() % 3);
    Point d;
    for (int k = 0; k < 3; ++k)
      d[k] = a[k] + std::llround(s * static_cast<double>(b[k] - a[k]) + t * static_cast<double>(c[k] - a[k])) +
             (noise == 0 ? 0 : static_cast<std::int64_t>(random() % 3) - 1);
    // A scale of each axis turns no sign.
    const auto exponent = [&] { return static_cast<int>(random() % 300) - 180; };
    const std::array<int, 3> exponents = {exponent(), exponent(), exponent()};
    const Vec3 A = scaled(a, exponents), B = scaled(b, exponents), C = scaled(c, exponents), D = scaled(d, exponents);
    const int expected = whole_orientation(a, b, c, d);
    ASSERT_EQ(orientation(A, B, C, D), expected) << "trial " << trial;
    flat += expected == 0;
    const double rounded = (B - A).dot((C - A).cross(D - A));
    misjudged += (rounded > 0.0) - (rounded < 0.0) != expected;
  }
  EXPECT_GT(flat, k_trials / 100) << "the inputs are not degenerate enough to show anything";
  EXPECT_GT(misjudged, k_trials / 100) << "nor so that rounding errs";
}

TEST(Orientation, VolumeSignNeedsNoPointInCommon) {
  std::mt19937_64 random(5);
  int flat = 0;
  constexpr int k_trials = 300000;
  for (int trial = 0; trial < k_trials; ++trial) {
    // Three differences of small numbers far from 0: nearly always rounded when they are scaled so.
    std::array<Point, 6> at;
    std::array<Point, 3> difference;
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < 3; ++k) {
        at[2 * v][k] = static_cast<std::int64_t>(random() % (std::int64_t{1} << 50));
        difference[v][k] = static_cast<std::int64_t>(random() % 7) - 3;
        at[2 * v + 1][k] = at[2 * v][k] + difference[v][k];
      }
    std::array<Vec3, 6> x;
    for (int k = 0; k < 6; ++k) x[k] = scaled(at[k], {-50, -50, -50});
    const Point none = {0, 0, 0};
    const int expected = whole_orientation(none, difference[0], difference[1], difference[2]);
    ASSERT_EQ(volume_sign(x[0], x[1], x[2], x[3], x[4], x[5]), expected) << "trial " << trial;
    flat += expected == 0;
  }
  EXPECT_GT(flat, k_trials / 100);
}

TEST(Orientation, CrossSignAgreesWithLongIntegers) {
  std::mt19937_64 random(4);
  int flat = 0;
  for (int trial = 0; trial < 1000000; ++trial) {
    const int bits = static_cast<int>(random() % 49) + 3;
    const std::int64_t limit = std::int64_t{1} << bits;
    const auto coordinate = [&] { return static_cast<std::int64_t>(random() % (2 * limit)) - limit; };
    const Point a = {coordinate(), coordinate(), coordinate()}, b = {coordinate(), coordinate(), coordinate()};
    const Point c = {coordinate(), coordinate(), coordinate()};
    Point d;
    for (int k = 0; k < 3; ++k)
      d[k] = c[k] + (b[k] - a[k]) / (1 + static_cast<std::int64_t>(trial % 3)) + static_cast<int>(random() % 3) - 1;
    const int axis = trial % 3, y = (axis + 1) % 3, z = (axis + 2) % 3;
    const Int128 area =
        static_cast<Int128>(b[y] - a[y]) * (d[z] - c[z]) - static_cast<Int128>(b[z] - a[z]) * (d[y] - c[y]);
    const int expected = (area > 0) - (area < 0);
    const std::array<int, 3> none = {};
    ASSERT_EQ(cross_sign(scaled(a, none), scaled(b, none), scaled(c, none), scaled(d, none), axis), expected);
    flat += expected == 0;
  }
  EXPECT_GT(flat, 10000);
}

TEST(Orientation, ReachesTheLeastAndTheLargestCoordinates) {
  for (const double size : {k_least_exact, 1.0, k_largest_exact}) {
    const Vec3 a(size, 0, 0), b(0, size, 0), c(0, 0, size);
    EXPECT_EQ(orientation(a, b, c, Vec3::Zero()), -1) << size;
    EXPECT_EQ(orientation(a, b, c, Vec3(size, size, size)), 1) << size;
    EXPECT_EQ(orientation(a, b, c, Vec3(0.25 * size, 0.25 * size, 0.5 * size)), 0) << size;
  }
  // Of such different sizes that no double holds their differences.
  const Vec3 a(0, 0, 1), b(1e70, 0, 1), c(0, 1e70, 1);
  EXPECT_EQ(orientation(a, b, c, Vec3(1e70, 1e70, 1)), 0);
  EXPECT_EQ(orientation(Vec3(1e70, 0, 0), Vec3(0, 1e-70, 0), Vec3(0, 0, 0), Vec3(0, 0, 1e-70)), 1);
}

// Segment and triangle.

/// The same question of whole numbers, with the step taken in earnest: coordinates of at most 4, a step of 2^-12.
int whole_passage(const std::array<Point, 5>& points, int step) {
  std::array<Point, 5> p = points;
  for (Point& x : p)
    for (std::int64_t& coordinate : x) coordinate *= std::int64_t{1} << 36;
  for (int end = 0; end < 2; ++end)
    for (int k = 0; k < 3; ++k) p[end][k] += step * (std::int64_t{1} << (24 - 12 * k));
  const int from = whole_orientation(p[2], p[3], p[4], p[0]), way = whole_orientation(p[2], p[3], p[4], p[1]);
  if (from * way != -1) return 0;
  for (int k = 0; k < 3; ++k)
    if (whole_orientation(p[0], p[1], p[2 + k], p[2 + (k + 1) % 3]) != way) return 0;
  return way;
}

TEST(SegmentTriangle, TouchingIsToldApartAsASmallStepDoes) {
  std::mt19937_64 random(6);
  int through = 0, touching = 0;
  constexpr int k_trials = 1000000;
  for (int trial = 0; trial < k_trials; ++trial) {
    std::array<Point, 5> points;
    for (Point& p : points)
      for (std::int64_t& coordinate : p) coordinate = static_cast<std::int64_t>(random() % 5) - 2;
    std::array<Vec3, 5> x;
    for (int k = 0; k < 5; ++k) x[k] = scaled(points[k], {});
    const int behind = passage_through(x[0], x[1], x[2], x[3], x[4], Beside::behind);
    const int before = passage_through(x[0], x[1], x[2], x[3], x[4], Beside::before);
    ASSERT_EQ(behind, whole_passage(points, 1)) << "trial " << trial;
    ASSERT_EQ(before, whole_passage(points, -1)) << "trial " << trial;
    through += behind != 0;
    touching += behind != before;
  }
  EXPECT_GT(through, k_trials / 50);
  EXPECT_GT(touching, k_trials / 50) << "few of the inputs touch";
}

TEST(SegmentTriangle, ANeedleGoesThroughOneTriangleAndTheWayIsTold) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), above(0.2, 0.3, 1), below(0.2, 0.3, -1);
  EXPECT_EQ(passage_through(below, above, a, b, c), 1);
  EXPECT_EQ(passage_through(above, below, a, b, c), -1);
  EXPECT_EQ(passage_through(above, Vec3(0.2, 0.3, 1e-300), a, b, c), 0);
  EXPECT_EQ(passage_through(Vec3(2, 2, 1), Vec3(2, 2, -1), a, b, c), 0);
}

TEST(SegmentTriangle, ASharedEdgeAndTheMiddleOfAFanAreGoneThroughOnce) {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    // A fan about 0 in the plane z = 0, and a needle through points of it that are exact.
    const int blades = 3 + trial % 6;
    std::vector<Vec3> rim;
    for (int k = 0; k < blades; ++k)
      rim.push_back(
          Vec3(std::cos(2.0 * std::numbers::pi * k / blades), std::sin(2.0 * std::numbers::pi * k / blades), 0.0));
    const auto number = [&] { return static_cast<double>(random() % 2001) / 1000.0 - 1.0; };
    const Vec3 at = trial % 2 ? Vec3(Vec3::Zero()) : Vec3(0.5 * rim[trial % blades]);
    const Vec3 along(number(), number(), 1.0 + std::abs(number()));
    for (const Beside beside : {Beside::before, Beside::behind}) {
      int net = 0, count = 0;
      for (int k = 0; k < blades; ++k) {
        const int way = passage_through(at - along, at + along, Vec3::Zero(), rim[k], rim[(k + 1) % blades], beside);
        net += way;
        count += way != 0;
      }
      EXPECT_EQ(count, 1) << "trial " << trial;
      EXPECT_EQ(net, 1) << "trial " << trial;
    }
  }
}

TEST(SegmentTriangle, WhatHasNoAreaOrLiesInThePlaneIsNotGoneThrough) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  for (const Beside beside : {Beside::before, Beside::behind}) {
    EXPECT_EQ(passage_through(Vec3(-1, 0.2, 0), Vec3(1, 0.2, 0), a, b, c, beside), 0);
    EXPECT_EQ(passage_through(Vec3(0.5, -1, 0), Vec3(0.5, 1, 0), a, b, Vec3(2, 0, 0), beside), 0);
    EXPECT_EQ(passage_through(Vec3(0, 0, -1), Vec3(0, 0, 1), a, a, a, beside), 0);
    EXPECT_EQ(passage_through(Vec3(0.2, 0.2, 0), Vec3(0.2, 0.2, 0), a, b, c, beside), 0);
  }
}

} // namespace
