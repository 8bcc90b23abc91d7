// The count of passages against moments found one by one, against linking numbers, and where everything touches.
#include "proxies/crossing/segment_passages.h"
#include "tests/support/collider_scenes.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::proxies;

namespace {

Vec3 on(const MovingPoint& point, double t) { return point.from + t * (point.to - point.from); }

/// The twin: the sign of the volume at many times, and whether the segments meet where it changes.
int sampled_passages(const MovingPoint& p, const MovingPoint& q, const MovingPoint& a, const MovingPoint& b) {
  const auto volume = [&](double t) {
    return (on(q, t) - on(p, t)).dot((on(a, t) - on(p, t)).cross(on(b, t) - on(p, t)));
  };
  int net = 0;
  constexpr int k_steps = 20000;
  for (int k = 0; k < k_steps; ++k) {
    const double t0 = static_cast<double>(k) / k_steps, t1 = static_cast<double>(k + 1) / k_steps;
    if ((volume(t0) <= 0.0) == (volume(t1) <= 0.0)) continue;
    // In the plane they share at this moment, seen along its normal, do they cross?
    const Vec3 P = on(p, t0), Q = on(q, t0), A = on(a, t0), B = on(b, t0), normal = (Q - P).cross(B - A);
    const auto side = [&](const Vec3& x, const Vec3& y, const Vec3& z) {
      return normal.dot((y - x).cross(z - x)) > 0.0;
    };
    if (side(P, Q, A) != side(P, Q, B) && side(A, B, P) != side(A, B, Q)) net += volume(t0) <= 0.0 ? 1 : -1;
  }
  return net;
}

TEST(SegmentPassages, OfSegmentsThatDoNotTurnAreTheMomentsTheyMeet) {
  std::mt19937_64 random(5);
  int hits = 0;
  constexpr int k_trials = 400;
  for (int trial = 0; trial < k_trials; ++trial) {
    const auto moving = [&](const Vec3& from, const Vec3& way) { return MovingPoint{from, from + way}; };
    const Vec3 first = test::random_point(random, 1.0), second = test::random_point(random, 1.0);
    const MovingPoint p = moving(test::random_point(random, 1.0), first),
                      q = moving(test::random_point(random, 1.0), first);
    const MovingPoint a = moving(test::random_point(random, 1.0), second),
                      b = moving(test::random_point(random, 1.0), second);
    const int net = net_passages(p, q, a, b);
    EXPECT_EQ(net, sampled_passages(p, q, a, b)) << "trial " << trial;
    EXPECT_EQ(net_passages(q, p, a, b), -net);
    EXPECT_EQ(net_passages(p, q, b, a), -net);
    EXPECT_EQ(net_passages({p.to, p.from}, {q.to, q.from}, {a.to, a.from}, {b.to, b.from}), -net);
    hits += net != 0;
  }
  EXPECT_GT(hits, k_trials / 20);
  EXPECT_LT(hits, k_trials / 2);
}

TEST(SegmentPassages, OfAnyMotionAreTheMomentsTheyMeetWhereStepsAreSmall) {
  // Sides of two triangles each come as near to the curved ones as parts of the motion are many. In one step they
  // differ for few: of segments about 1 m long whose ends go as far (0.1 as far) for 52 (1) in 300.
  std::mt19937_64 random(6);
  for (const double way : {1.0, 0.1}) {
    int hits = 0, in_one_step = 0;
    constexpr int k_trials = 300, k_parts = 500;
    for (int trial = 0; trial < k_trials; ++trial) {
      std::array<MovingPoint, 4> whole;
      for (MovingPoint& point : whole) {
        const Vec3 middle = test::random_point(random, trial % 2 ? 0.3 : 0.5),
                   half = test::random_point(random, 0.5 * way);
        point = {middle - half, middle + half};
      }
      int net = 0;
      for (int part = 0; part < k_parts; ++part) {
        std::array<MovingPoint, 4> x;
        for (int k = 0; k < 4; ++k)
          x[k] = {on(whole[k], static_cast<double>(part) / k_parts),
                  on(whole[k], static_cast<double>(part + 1) / k_parts)};
        net += net_passages(x[0], x[1], x[2], x[3]);
      }
      const int sampled = sampled_passages(whole[0], whole[1], whole[2], whole[3]);
      EXPECT_EQ(net, sampled) << "trial " << trial;
      hits += sampled != 0;
      in_one_step += net_passages(whole[0], whole[1], whole[2], whole[3]) == sampled;
    }
    EXPECT_GE(hits, k_trials / 30);
    EXPECT_GE(in_one_step, way < 1.0 ? k_trials - 3 : k_trials * 8 / 10);
  }
}

using Loop = std::vector<Vec3>;

/// How often two loops are linked, by half the signed crossings of a picture of them, seen askew.
int linking_number(const Loop& one, const Loop& other) {
  const Eigen::Matrix3d askew = Eigen::AngleAxisd(0.7, Vec3(0.3, 0.9, -0.5).normalized()).toRotationMatrix();
  int twice = 0;
  for (std::size_t i = 0; i < one.size(); ++i)
    for (std::size_t j = 0; j < other.size(); ++j) {
      const Vec3 p = askew * one[i], q = askew * one[(i + 1) % one.size()];
      const Vec3 a = askew * other[j], b = askew * other[(j + 1) % other.size()];
      const auto area = [](const Vec3& u, const Vec3& v, const Vec3& w) {
        return (v - u).head<2>().x() * (w - u).y() - (v - u).y() * (w - u).x();
      };
      const double pa = area(p, q, a), pb = area(p, q, b), ap = area(a, b, p), aq = area(a, b, q);
      if ((pa > 0) == (pb > 0) || (ap > 0) == (aq > 0)) continue;
      const double height = p.z() + ap / (ap - aq) * (q.z() - p.z()),
                   other_height = a.z() + pa / (pa - pb) * (b.z() - a.z());
      twice += (pb > 0 ? 1 : -1) * (height > other_height ? 1 : -1);
    }
  EXPECT_EQ(twice % 2, 0);
  return twice / 2;
}

int net_of_loops(const Loop& one, const Loop& one_to, const Loop& other, const Loop& other_to) {
  int net = 0;
  for (std::size_t i = 0; i < one.size(); ++i)
    for (std::size_t j = 0; j < other.size(); ++j) {
      const std::size_t next = (i + 1) % one.size(), after = (j + 1) % other.size();
      net += net_passages({one[i], one_to[i]}, {one[next], one_to[next]}, {other[j], other_to[j]},
                          {other[after], other_to[after]});
    }
  return net;
}

TEST(SegmentPassages, OfLoopsAreWhatTheirLinkingNumberChangesBy) {
  std::mt19937_64 random(7);
  int changes = 0;
  constexpr int k_trials = 1000;
  for (int trial = 0; trial < k_trials; ++trial) {
    const auto loop = [&](int corners) {
      Loop points;
      for (int k = 0; k < corners; ++k) points.push_back(test::random_point(random, 1.0));
      return points;
    };
    const Loop one = loop(7), one_to = loop(7), other = loop(5), other_to = loop(5);
    const int change = linking_number(one_to, other_to) - linking_number(one, other);
    EXPECT_EQ(net_of_loops(one, one_to, other, other_to), change) << "trial " << trial;
    changes += change != 0;
  }
  EXPECT_GT(changes, k_trials * 3 / 10);
}

Vec3 on_grid(std::mt19937_64& random, int size) {
  const auto number = [&] { return static_cast<double>(random() % size); };
  const double x = number(), y = number(), z = number();
  return {x, y, z};
}

TEST(SegmentPassages, WhatTouchesIsToldApartAsASmallStepDoes) {
  std::mt19937_64 random(8);
  const Vec3 step(0x1p-12, 0x1p-24, 0x1p-36);
  int through = 0, touching = 0;
  constexpr int k_trials = 300000;
  for (int trial = 0; trial < k_trials; ++trial) {
    std::array<MovingPoint, 4> x;
    for (MovingPoint& point : x) {
      point.from = on_grid(random, 4);
      point.to = on_grid(random, 4);
    }
    const auto beside = [&](const MovingPoint& point, double way) {
      return MovingPoint{point.from + way * step, point.to + way * step};
    };
    const int net = net_passages(x[0], x[1], x[2], x[3]);
    ASSERT_EQ(net, net_passages(x[0], x[1], beside(x[2], 1.0), beside(x[3], 1.0))) << "trial " << trial;
    through += net != 0;
    touching += net != net_passages(x[0], x[1], beside(x[2], -1.0), beside(x[3], -1.0));
  }
  EXPECT_GT(through, k_trials / 50);
  EXPECT_GT(touching, k_trials / 50) << "few of the inputs touch";
}

TEST(SegmentPassages, LoopsThatComeBackHavePassedAsOftenEitherWay) {
  // On a small grid, where all touches all.
  std::mt19937_64 random(9);
  int moved = 0;
  constexpr int k_trials = 3000;
  for (int trial = 0; trial < k_trials; ++trial) {
    std::array<Loop, 3> one, other;
    for (int stage = 0; stage < 3; ++stage) {
      for (int k = 0; k < 4; ++k) one[stage].push_back(on_grid(random, 3));
      for (int k = 0; k < 3; ++k) other[stage].push_back(on_grid(random, 3));
    }
    int sum = 0;
    for (int stage = 0; stage < 3; ++stage) {
      const int next = (stage + 1) % 3;
      const int net = net_of_loops(one[stage], one[next], other[stage], other[next]);
      moved += net != 0;
      sum += net;
    }
    EXPECT_EQ(sum, 0) << "trial " << trial;
  }
  EXPECT_GT(moved, k_trials / 10);
}

TEST(SegmentPassages, WhatMovesTogetherNeverPasses) {
  std::mt19937_64 random(10);
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 way = 7.0 * on_grid(random, 4);
    std::array<MovingPoint, 4> x;
    for (MovingPoint& point : x) {
      point.from = trial % 2 ? on_grid(random, 3) : Vec3(on_grid(random, 1 << 20) * 0x1p-18);
      point.to = point.from + way; // exactly
    }
    EXPECT_EQ(net_passages(x[0], x[1], x[2], x[3]), 0) << "trial " << trial;
  }
}

TEST(SegmentPassages, ANeedleThroughTheJointOfAPathPassesOnce) {
  // A path along x, bent at 0, goes up through an axis along z; both ways round, head-on and off.
  for (const double way : {1.0, -1.0})
    for (const double off : {0.0, 1e-300, 0.25}) {
      const std::vector<Vec3> path = {{-1 - off, 0, 0}, {-off, 0, 0}, {1, 0.0, 0.1}};
      int net = 0, count = 0;
      for (int k = 0; k < 2; ++k) {
        const auto moving = [&](const Vec3& x) { return MovingPoint{x - Vec3(0, way, 0), x + Vec3(0, way, 0)}; };
        const int one =
            net_passages(moving(path[k]), moving(path[k + 1]), {{0, 0, -1}, {0, 0, -1}}, {{0, 0, 1}, {0, 0, 1}});
        net += one;
        count += one != 0;
      }
      EXPECT_EQ(count, 1) << off;
      EXPECT_EQ(std::abs(net), 1) << off;
    }
}

} // namespace
