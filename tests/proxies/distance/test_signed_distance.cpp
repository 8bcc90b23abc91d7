// The closed forms against definitions: dense sampling of the axis, analytic cases, and the convention itself.
#include "proxies/distance/signed_distance.h"

#include "proxies/distance/capsule_union.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/nearest_search.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace tutu;
using namespace tutu::proxies;
using tutu::test::random_point;
using tutu::test::search_point;

namespace {

/// The convention of proxies/contact.h, relative to the sizes at hand.
void expect_convention(const Vec3& point, const Contact& contact) {
  const double scale = std::max(1.0, std::abs(contact.distance));
  EXPECT_LE((contact.closest + contact.distance * contact.normal - point).norm(), 1e-12 * scale);
  EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-14);
}

/// Distance to the nearest of very many points of the axis: an upper bound, and close.
double sampled_distance(const Vec3& point, const Capsule& capsule) {
  constexpr int k_samples = 2000;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= k_samples; ++i) {
    const double t = static_cast<double>(i) / k_samples;
    least = std::min(least, (point - ((1.0 - t) * capsule.a + t * capsule.b)).norm() - capsule.radius_at(t));
  }
  return least;
}

TEST(SignedDistance, CapsuleMatchesDenseSampling) {
  std::mt19937_64 random(1);
  int inside = 0;
  constexpr int k_cases = 2000;
  for (int i = 0; i < k_cases; ++i) {
    const Capsule capsule{random_point(random, 0.3), random_point(random, 0.3), 0.3};
    const Vec3 point = random_point(random, 0.35);
    const Contact contact = signed_distance(point, capsule);
    const double sampled = sampled_distance(point, capsule);
    EXPECT_LE(contact.distance, sampled + 1e-15);
    EXPECT_GE(contact.distance, sampled - 0.5 * (capsule.b - capsule.a).norm() / 2000);
    expect_convention(point, contact);
    EXPECT_NEAR(search_point(contact.closest, capsule).distance, 0.0, 1e-14);
    inside += contact.distance < 0.0;
  }
  EXPECT_GT(inside, 0.3 * k_cases);
  EXPECT_LT(inside, 0.7 * k_cases);
}

TEST(SignedDistance, ConeMatchesDenseSamplingAndItsNormalLeans) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> radius(0.05, 0.4);
  int inside = 0, swallowed = 0, beside = 0;
  constexpr int k_cases = 3000;
  for (int i = 0; i < k_cases; ++i) {
    Capsule capsule{random_point(random, 0.25), random_point(random, 0.25), radius(random)};
    capsule.taper = radius(random) - capsule.radius;
    const Vec3 point = random_point(random, 0.3), axis = capsule.b - capsule.a;
    const Contact contact = signed_distance(point, capsule);
    const double sampled = sampled_distance(point, capsule);
    EXPECT_LE(contact.distance, sampled + 1e-15);
    EXPECT_GE(contact.distance, sampled - axis.norm() / 2000);
    expect_convention(point, contact);
    EXPECT_NEAR(search_point(contact.closest, capsule).distance, 0.0, 1e-14);
    inside += contact.distance < 0.0;
    if (axis.norm() <= std::abs(capsule.taper)) {
      ++swallowed;
      EXPECT_EQ(std::abs(cone_sine(capsule)), 1.0);
      const Vec3& centre = capsule.taper > 0.0 ? capsule.b : capsule.a;
      EXPECT_NEAR(contact.distance, (point - centre).norm() - capsule.widest(), 1e-14);
      continue;
    }
    const double t = search_point(point, capsule).t;
    EXPECT_NEAR(nearest_on_axis(point, capsule), t, 1e-12);
    if (t <= 0.0 || t >= 1.0) continue;
    ++beside;
    EXPECT_NEAR(contact.normal.dot(axis), -capsule.taper, 1e-12);
    const Vec3 on_axis = capsule.a + 0.4 * axis;
    EXPECT_NEAR(normal_on_axis(capsule).dot(axis), -capsule.taper, 1e-12);
    EXPECT_NEAR(signed_distance(on_axis, capsule).distance, search_point(on_axis, capsule).distance, 1e-12);
  }
  EXPECT_GT(inside, 0.3 * k_cases);
  EXPECT_LT(inside, 0.7 * k_cases);
  EXPECT_GT(swallowed, 0.05 * k_cases);
  EXPECT_GT(beside, 0.2 * k_cases);
}

TEST(SignedDistance, NormalIsTheGradient) {
  std::mt19937_64 random(2);
  const double h = 1e-6;
  for (int i = 0; i < 1000; ++i) {
    const Capsule capsule{random_point(random, 0.5), random_point(random, 0.5), 0.2};
    const Vec3 point = random_point(random, 0.8);
    const Contact contact = signed_distance(point, capsule);
    if (contact.distance + capsule.radius < 0.01) continue; // the axis: no gradient
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = h * Vec3::Unit(k);
      const double slope =
          (signed_distance(point + step, capsule).distance - signed_distance(point - step, capsule).distance) / (2 * h);
      EXPECT_NEAR(contact.normal[k], slope, 1e-6);
    }
  }
}

TEST(SignedDistance, AnalyticCasesOfACapsule) {
  const Capsule capsule{{-1, 0, 0}, {1, 0, 0}, 0.5};
  const auto expect = [&](const Vec3& point, double distance, const Vec3& normal, const Vec3& closest) {
    const Contact contact = signed_distance(point, capsule);
    EXPECT_NEAR(contact.distance, distance, 1e-15);
    EXPECT_LE((contact.normal - normal).norm(), 1e-15);
    EXPECT_LE((contact.closest - closest).norm(), 1e-15);
  };
  expect({0.3, 0, 2}, 1.5, Vec3::UnitZ(), {0.3, 0, 0.5});       // beside
  expect({3, 0, 0}, 1.5, Vec3::UnitX(), {1.5, 0, 0});           // beyond an end
  expect({-1.3, 0.4, 0}, 0.0, {-0.6, 0.8, 0}, {-1.3, 0.4, 0});  // on a cap
  expect({0.7, -0.1, 0}, -0.4, -Vec3::UnitY(), {0.7, -0.5, 0}); // inside
  expect({0.2, 0, -0.5}, 0.0, -Vec3::UnitZ(), {0.2, 0, -0.5});  // on the side
}

TEST(SignedDistance, OnTheAxisTheNormalIsTheUpmostPerpendicular) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Capsule capsule{random_point(random, 1.0), random_point(random, 1.0), 0.1};
    const Vec3 u = (capsule.b - capsule.a).normalized();
    for (const double t : {0.0, 0.25, 0.5, 1.0}) {
      const Vec3 point = (1.0 - t) * capsule.a + t * capsule.b;
      const Contact contact = signed_distance(point, capsule);
      EXPECT_NEAR(contact.distance, -0.1, 1e-12);
      expect_convention(point, contact);
      EXPECT_NEAR(contact.normal.dot(u), 0.0, 1e-13);
      EXPECT_NEAR(contact.normal.y(), std::sqrt(1.0 - u.y() * u.y()),
                  1e-7); // cos of the angle between +Y and the plane
    }
  }
}

TEST(SignedDistance, OnTheAxisSpecialDirections) {
  const auto normal_inside = [](const Vec3& a, const Vec3& b) {
    const Contact contact = signed_distance(a, Capsule{a, b, 0.2});
    EXPECT_EQ(contact.distance, -0.2);
    expect_convention(a, contact);
    return contact.normal;
  };
  EXPECT_EQ(normal_inside({1, 2, 3}, {1, 2, 3}), Vec3::UnitY()); // a sphere
  EXPECT_EQ(normal_inside({0, 1, 0}, {0, 3, 0}), Vec3::UnitX()); // vertical
  EXPECT_EQ(normal_inside({0, 3, 0}, {0, 1, 0}), Vec3::UnitX());
  EXPECT_EQ(normal_inside({0, 0, 0}, {1, 0, 0}), Vec3::UnitY()); // lying
  EXPECT_EQ(normal_inside({0, 0, 0}, {0, 0, -1}), Vec3::UnitY());
  // Nearly vertical: still perpendicular to the last bits.
  const Vec3 leaning(1e-7, 1.0, -2e-7);
  EXPECT_NEAR(normal_inside(Vec3::Zero(), leaning).dot(leaning), 0.0, 1e-20);
}

TEST(SignedDistance, NoLengthIsASphere) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 centre = random_point(random, 1.0), point = random_point(random, 1.0);
    const Contact contact = signed_distance(point, Capsule{centre, centre, 0.3});
    EXPECT_NEAR(contact.distance, (point - centre).norm() - 0.3, 1e-15);
    EXPECT_LE((contact.normal - (point - centre).normalized()).norm(), 1e-14);
  }
  // Lengths that vanish when squared.
  const Contact tiny = signed_distance({0.5, 0, 0}, Capsule{Vec3::Zero(), {0, 1e-200, 0}, 0.3});
  EXPECT_EQ(tiny.distance, 0.2);
  EXPECT_EQ(signed_distance(Vec3::Zero(), Capsule{Vec3::Zero(), {1e-200, 0, 0}, 0.3}).normal, Vec3::UnitY());
}

TEST(SignedDistance, FarAway) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    const Capsule capsule{random_point(random, 1.0), random_point(random, 1.0), 0.1};
    const Vec3 point = random_point(random, 1e6);
    const Contact contact = signed_distance(point, capsule);
    expect_convention(point, contact);
    EXPECT_NEAR(search_point(contact.closest, capsule).distance, 0.0, 1e-9); // of 1e6
  }
}

TEST(CapsuleUnion, IsTheLeastOfAll) {
  std::mt19937_64 random(8);
  int inside = 0;
  constexpr int k_cases = 1000;
  for (int i = 0; i < k_cases; ++i) {
    const test::ColliderScene scene = test::random_scene(random, 30, 0, 0.0);
    CapsuleUnion solid;
    solid.assign(scene.start);
    const Vec3 point = random_point(random, 0.3);
    double least = std::numeric_limits<double>::infinity(), least_but_last = least;
    for (const Capsule& capsule : scene.start) {
      least_but_last = least;
      least = std::min(least, search_point(point, capsule).distance);
    }
    EXPECT_NEAR(solid.distance(point), least, 1e-14);
    EXPECT_NEAR(solid.distance_without(point, 29), least_but_last, 1e-14);
    EXPECT_NEAR(search_point(point, scene.start[solid.nearest(point).capsule]).distance, least, 1e-14);
    inside += least < 0.0;
  }
  EXPECT_GT(inside, 0.3 * k_cases);
  EXPECT_LT(inside, 0.7 * k_cases);
}

TEST(SignedDistance, Plane) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 1000; ++i) {
    const Plane plane{random_point(random, 1.0).normalized(), 0.7};
    const Vec3 point = random_point(random, 2.0);
    const Contact contact = signed_distance(point, plane);
    expect_convention(point, contact);
    EXPECT_EQ(contact.normal, plane.normal);
    EXPECT_NEAR(plane.normal.dot(contact.closest), 0.7, 1e-14);
  }
  EXPECT_EQ(signed_distance({5, -0.25, 3}, Plane{}).distance, -0.25);
}

} // namespace
