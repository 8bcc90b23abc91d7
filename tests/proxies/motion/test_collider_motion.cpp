// How colliders move within a frame, against plain trigonometry, dense sampling and exact rigid motions.
#include "proxies/motion/collider_motion.h"

#include "tests/support/collider_scenes.h"
#include "tests/support/nearest_search.h"

#include <gtest/gtest.h>
#include <limits>

using namespace tutu;
using namespace tutu::proxies;
using tutu::test::random_point;
using tutu::test::search_point;

namespace {

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  return Vec3(gauss(random), gauss(random), gauss(random)).normalized();
}

Capsule moved(const Capsule& capsule, const Transform& motion) {
  return {motion * capsule.a, motion * capsule.b, capsule.radius};
}

Transform turn_about(const Vec3& centre, const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  const Quat rotation(Eigen::AngleAxisd(angle, angle > 0.0 ? Vec3(rotation_vector / angle) : Vec3(Vec3::UnitX())));
  return {rotation, centre - rotation * centre};
}

/// A capsule of 2 cm to 1 m, turned by up to `most` rad about its middle, shifted and, every third time, stretched.
std::pair<Capsule, Capsule> random_turn(std::mt19937_64& random, double most, int i) {
  std::uniform_real_distribution<double> length(0.01, 0.5), angle(0.0, most), stretch(0.5, 2.0);
  const Vec3 middle = random_point(random, 1.0), half = length(random) * random_direction(random);
  const Capsule start{middle - half, middle + half, 0.05};
  const Vec3 axis = half.cross(random_direction(random)).normalized();
  const Vec3 turned = Eigen::AngleAxisd(angle(random), axis) * half * (i % 3 ? 1.0 : stretch(random));
  const Vec3 end = middle + random_point(random, 0.1);
  return {start, {end - turned, end + turned, 0.05}};
}

bool same(const Capsule& p, const Capsule& q) { return p.a == q.a && p.b == q.b && p.radius == q.radius; }

TEST(CapsuleAt, TurnsEvenlyAboutAMiddleOnAStraightLine) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const auto [start, end] = random_turn(random, i % 2 ? 0.2 : 3.1, i);
    const Vec3 from = (start.b - start.a) / 2, to = (end.b - end.a) / 2;
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    const Vec3 axis = from.cross(to).normalized();
    for (const double s : {0.0, 0.01, 0.25, 0.5, 0.77, 0.999, 1.0}) {
      const Capsule now = capsule_at(start, end, s);
      const Vec3 middle = 0.5 * ((1 - s) * (start.a + start.b) + s * (end.a + end.b));
      const double length = (1 - s) * from.norm() + s * to.norm();
      const Vec3 half = length * (Eigen::AngleAxisd(s * angle, axis) * from.normalized());
      EXPECT_LE((now.a - (middle - half)).norm(), 1e-14) << angle;
      EXPECT_LE((now.b - (middle + half)).norm(), 1e-14) << angle;
      EXPECT_EQ(now.radius, start.radius);
    }
  }
}

TEST(CapsuleAt, EndsAndWhatStandsStillKeepTheirBits) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 500; ++i) {
    const auto [start, end] = random_turn(random, 3.0, i);
    EXPECT_TRUE(same(capsule_at(start, end, 0.0), start));
    EXPECT_TRUE(same(capsule_at(start, end, 1.0), end));
    for (double s = 0.0; s <= 1.0; s += 0.03) EXPECT_TRUE(same(capsule_at(start, start, s), start));
  }
}

TEST(CapsuleAt, WithoutAShorterArcEndsGoStraight) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    auto [start, end] = random_turn(random, 3.0, i);
    if (i % 4 == 0) start.b = start.a, end.b = end.a;           // a sphere
    if (i % 4 == 1) end.b = end.a;                              // shrinks to one
    if (i % 4 == 2) start.b = start.a + Vec3::Constant(1e-200); // its length vanishes when squared
    if (i % 4 == 3) end.a = start.b, end.b = start.a;           // half a turn
    if (i % 8 == 7) end.a += Vec3::Constant(0.1), end.b += Vec3::Constant(0.1);
    for (const double s : {0.1, 0.5, 0.8}) {
      const Capsule now = capsule_at(start, end, s);
      EXPECT_LE((now.a - ((1 - s) * start.a + s * end.a)).norm(), 1e-15);
      EXPECT_LE((now.b - ((1 - s) * start.b + s * end.b)).norm(), 1e-15);
    }
  }
}

TEST(AxisMotion, IsTheDerivative) {
  std::mt19937_64 random(6);
  const double h = 1e-4;
  for (int i = 0; i < 2000; ++i) {
    auto [start, end] = random_turn(random, i % 2 ? 0.3 : 3.0, i);
    if (i % 7 == 0) start.b = start.a; // straight
    const AxisMotion motion = axis_motion(start, end);
    const auto half = [](const Capsule& capsule) { return Vec3((capsule.b - capsule.a) / 2); };
    const auto middle = [](const Capsule& capsule) { return Vec3((capsule.b + capsule.a) / 2); };
    for (const double s : {0.1, 0.5, 0.9}) {
      const Capsule before = capsule_at(start, end, s - h), now = capsule_at(start, end, s),
                    after = capsule_at(start, end, s + h);
      EXPECT_LE((motion.middle - (middle(after) - middle(before)) / (2 * h)).norm(), 1e-11);
      const Vec3 velocity = motion.straight + motion.stretch * half(now).normalized() + motion.turn.cross(half(now));
      EXPECT_LE((velocity - (half(after) - half(before)) / (2 * h)).norm(), 1e-7);
    }
  }
}

TEST(CapsuleAt, PartOfAWayIsTheSameWay) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 1000; ++i) {
    const auto [start, end] = random_turn(random, 2.5, i);
    const Capsule from = capsule_at(start, end, 0.2), to = capsule_at(start, end, 0.7);
    for (const double s : {0.1, 0.5, 0.9}) {
      const Capsule part = capsule_at(from, to, s), whole = capsule_at(start, end, 0.2 + 0.5 * s);
      EXPECT_LE((part.a - whole.a).norm() + (part.b - whole.b).norm(), 1e-13);
    }
  }
}

TEST(SweptBounds, HoldEveryMomentAndAreTight) {
  std::mt19937_64 random(4);
  double room = 0.0, needed = 0.0; // beyond straight lines: given, and taken
  for (int i = 0; i < 3000; ++i) {
    const bool gentle = i % 2;
    const auto [start, end] = random_turn(random, gentle ? 0.3 : 3.1, i);
    const Box box = swept_box(start, end);
    const Capsule cover = swept_cover(start, end);
    double off = 0.0;
    for (int k = 0; k <= 64; ++k) {
      const double s = k / 64.0;
      const Capsule now = capsule_at(start, end, s);
      for (const Vec3& point : {now.a, now.b}) {
        EXPECT_TRUE((point.array() - now.radius >= box.min().array() - 1e-14).all()) << i << ' ' << s;
        EXPECT_TRUE((point.array() + now.radius <= box.max().array() + 1e-14).all()) << i << ' ' << s;
      }
      for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0}) // the ball about each point of the axis
        EXPECT_LE(search_point((1 - t) * now.a + t * now.b, cover, 30).distance, -now.radius + 1e-14) << i << ' ' << s;
      off = std::max(off, (now.a - ((1 - s) * start.a + s * end.a)).norm());
    }
    if (!gentle) continue;
    room += start.radius + 0.5 * std::max((end.a - start.a).norm(), (end.b - start.b).norm());
    room -= cover.radius;
    needed += off;
  }
  EXPECT_LE(-room, 1.2 * needed);
  EXPECT_GE(-room, needed);
}

TEST(SweptBounds, AreTheStraightOnesWhereNothingTurns) {
  const Capsule start{Vec3(0, 0, 0), Vec3(1, 0, 0), 0.5}, end{Vec3(0, 0, 2), Vec3(1, 0, 2), 0.5};
  EXPECT_EQ(swept_box(start, end).min(), Vec3(-0.5, -0.5, -0.5));
  EXPECT_EQ(swept_box(start, end).max(), Vec3(1.5, 0.5, 2.5));
  EXPECT_TRUE(same(swept_cover(start, end), Capsule{Vec3(0, 0, 1), Vec3(1, 0, 1), 1.5}));
  EXPECT_EQ(swept_box({Vec3::Zero(), Vec3::Zero(), 0.5}, {Vec3::UnitX(), Vec3::UnitX(), 0.5}).max(),
            Vec3(1.5, 0.5, 0.5));
}

TEST(SurfaceMotion, IsThatOfARigidBody) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> radius(0.02, 0.2);
  for (int i = 0; i < 5000; ++i) {
    Capsule before{random_point(random, 0.5), random_point(random, 0.5), radius(random)};
    if (i % 3 == 0) before.b = before.a; // a sphere
    const double angle = std::pow(10.0, -1.0 - i % 4);
    const Vec3 spin = angle * random_direction(random);
    Transform motion = turn_about(random_point(random, 0.5), spin);
    motion.translation += random_point(random, 0.05);
    const Capsule now = moved(before, motion);
    const Vec3 point = random_point(random, 1.0);
    const test::Searched nearest = search_point(point, now);
    const Vec3 on_surface = point - nearest.distance * nearest.normal;
    const Vec3 exact = on_surface - motion.inverse() * on_surface;
    EXPECT_LE((surface_motion(before, now, spin, point) - exact).norm(), 0.51 * now.radius * angle * angle + 1e-14)
        << i;
  }
}

TEST(SurfaceMotion, OfAWheelIsSpinTimesArm) {
  const Vec3 spin(0.01, 0, 0), down(0.3, 0, -0.2);
  const Capsule ball{Vec3::Zero(), Vec3::Zero(), 0.1}, wheel{Vec3::Zero(), Vec3::UnitX(), 0.1};
  for (const Capsule& capsule : {ball, wheel}) {
    EXPECT_LE((surface_motion(capsule, capsule, spin, Vec3(0, 0.3, 0)) - Vec3(0, 0, 0.001)).norm(), 1e-18);
    EXPECT_LE((surface_motion(capsule, capsule, spin, Vec3(0, 0, -0.01)) - Vec3(0, 0.001, 0)).norm(), 1e-18);
    EXPECT_EQ(surface_motion(capsule, moved(capsule, {Quat::Identity(), down}), Vec3::Zero(), Vec3::UnitY()), down);
  }
  // What the ends show already is not counted twice: only the spin along the axis is taken from `spin`.
  EXPECT_EQ(surface_motion(wheel, wheel, Vec3(0, 5, 7), Vec3(0.5, 0.3, 0)), Vec3::Zero());
  EXPECT_TRUE(surface_motion(wheel, wheel, spin, Vec3(0.5, 0, 0)).allFinite()); // on the axis
}

} // namespace
