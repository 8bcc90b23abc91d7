// Edges and triangles against capsules: the closed forms against a search that knows only that distance is convex.
#include "proxies/distance/feature_contact.h"

#include "tests/support/collider_scenes.h"
#include "tests/support/nearest_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

using namespace tutu;
using namespace tutu::proxies;
using tutu::test::random_point;
using tutu::test::random_taper;
using tutu::test::search_edge;
using tutu::test::search_triangle;

namespace {

/// The least value of a convex function on [0, 1].
template <class F> double least(const F& f) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double third = (high - low) / 3.0, left = low + third, right = high - third;
    if (f(left) < f(right)) high = right;
    else low = left;
  }
  return std::min({f(0.0), f(0.5 * (low + high)), f(1.0)});
}

/// By values alone: where an edge lies along the axis no direction from it tells anything.
double least_distance_by_value(const Vec3& p, const Vec3& q, const Capsule& capsule) {
  return least([&](double s) { return test::search_point((1 - s) * p + s * q, capsule).distance; });
}

/// What FeatureContact promises, whatever the case.
void expect_promises(const FeatureContact& contact, const std::array<Vec3, 3>& p, const Capsule& capsule) {
  Vec3 cloth = Vec3::Zero();
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(contact.weights[k], 0.0);
    sum += contact.weights[k];
    cloth += contact.weights[k] * p[k];
  }
  EXPECT_NEAR(sum, 1.0, 1e-15);
  EXPECT_TRUE(contact.on_axis >= 0.0 && contact.on_axis <= 1.0);
  EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-14);
  EXPECT_LE((contact.closest + contact.distance * contact.normal - cloth).norm(), 1e-14);
  const Vec3 on_axis = capsule.a + contact.on_axis * (capsule.b - capsule.a);
  const double radius = capsule.radius_at(contact.on_axis);
  EXPECT_NEAR((cloth - on_axis).norm() - radius, contact.distance, 1e-12);
  EXPECT_LE((on_axis + radius * contact.normal - contact.closest).norm(), 1e-12);
  const std::array<double, 3>& w = contact.weights;
  switch (contact.feature) {
  case ClothFeature::vertex: EXPECT_EQ(w[contact.index], 1.0); break;
  case ClothFeature::edge: EXPECT_TRUE(w[contact.index] > 0 && w[contact.index] < 1); break;
  case ClothFeature::face: EXPECT_TRUE(contact.on_axis == 0.0 || contact.on_axis == 1.0); break;
  case ClothFeature::crossing: EXPECT_EQ(contact.distance, -radius); break;
  }
}

TEST(EdgeContact, IsTheLeastDistanceOfAll) {
  std::mt19937_64 random(1);
  std::map<ClothFeature, int> seen;
  int inside = 0;
  constexpr int k_cases = 5000;
  for (int i = 0; i < k_cases; ++i) {
    Capsule capsule{random_point(random, 0.3), random_point(random, 0.3), 0.12, random_taper(random, 0.12, i)};
    if (i % 5 == 0) capsule.b = capsule.a, capsule.taper = 0.0;
    const Vec3 p = random_point(random, 0.3), q = random_point(random, 0.3);
    const FeatureContact contact = edge_contact(p, q, capsule, Vec3::Zero());
    EXPECT_NEAR(contact.distance, search_edge(p, q, capsule).distance, 1e-9) << i;
    expect_promises(contact, {p, q, Vec3::Zero()}, capsule);
    ++seen[contact.feature];
    inside += contact.distance < 0.0;
  }
  EXPECT_GT(inside, 0.3 * k_cases);
  EXPECT_LT(inside, 0.7 * k_cases);
  EXPECT_GT(seen[ClothFeature::vertex], 0.1 * k_cases);
  EXPECT_GT(seen[ClothFeature::edge], 0.1 * k_cases);
}

TEST(EdgeContact, NearlyParallelLosesNothing) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 2000; ++i) {
    const double lean = i % 10 == 0 ? 0.0 : std::pow(10.0, -2 - i % 16);
    const Vec3 a = random_point(random, 0.3), along = random_point(random, 0.5);
    const Capsule capsule{a, a + along, 0.05, random_taper(random, 0.05, i)};
    const double gap = i % 2 ? 0.1 : 0.0;
    const Vec3 sideways = along.cross(random_point(random, 1.0)).normalized();
    const double shift = std::uniform_real_distribution<double>(-1.5, 1.5)(random);
    const Vec3 p = a + shift * along + gap * sideways + lean * random_point(random, 1.0);
    const Vec3 q = p + (i % 3 ? 1.0 : -0.7) * along + lean * random_point(random, 1.0);
    const FeatureContact contact = edge_contact(p, q, capsule, sideways);
    expect_promises(contact, {p, q, Vec3::Zero()}, capsule);
    EXPECT_NEAR(contact.distance, least_distance_by_value(p, q, capsule), 1e-9) << i;
  }
}

class TriangleDistance : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(TriangleContact, TriangleDistance, ::testing::Bool(),
                         [](const auto& kind) { return kind.param ? "Cones" : "Capsules"; });

TEST_P(TriangleDistance, IsTheLeastOfAll) {
  std::mt19937_64 random(3);
  std::map<ClothFeature, int> seen;
  int inside = 0;
  constexpr int k_cases = 1500;
  for (int i = 0; i < k_cases; ++i) {
    Capsule capsule{random_point(random, 0.4), random_point(random, 0.4), 0.12};
    if (GetParam()) capsule.taper = random_taper(random, 0.12, i);
    if (i % 5 == 0) capsule.b = capsule.a, capsule.taper = 0.0;
    const std::array<Vec3, 3> p = {random_point(random, 0.4), random_point(random, 0.4), random_point(random, 0.4)};
    const FeatureContact contact = triangle_contact(p[0], p[1], p[2], capsule, Vec3::Zero());
    EXPECT_NEAR(contact.distance, search_triangle(p, capsule).distance, 1e-7) << i;
    expect_promises(contact, p, capsule);
    ++seen[contact.feature];
    inside += contact.distance < 0.0;
  }
  EXPECT_GT(inside, 0.3 * k_cases);
  EXPECT_LT(inside, 0.7 * k_cases);
  for (const ClothFeature feature : {ClothFeature::vertex, ClothFeature::edge, ClothFeature::face})
    EXPECT_GT(seen[feature], 0.08 * k_cases) << static_cast<int>(feature);
  // Some axes go through flatter than their cone grows: there the wide end is deeper.
  EXPECT_GT(seen[ClothFeature::crossing], (GetParam() ? 0.04 : 0.08) * k_cases);
}

TEST(TriangleContact, NormalIsTheGradient) {
  std::mt19937_64 random(4);
  const double h = 1e-6;
  for (int i = 0; i < 2000; ++i) {
    const Capsule capsule{random_point(random, 0.4), random_point(random, 0.4), 0.12};
    const std::array<Vec3, 3> p = {random_point(random, 0.4), random_point(random, 0.4), random_point(random, 0.4)};
    const FeatureContact contact = triangle_contact(p[0], p[1], p[2], capsule, Vec3::Zero());
    if (contact.distance + capsule.radius < 0.01) continue; // the axis: no gradient
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = h * Vec3::Unit(k);
      const auto distance = [&](const Vec3& move) {
        return triangle_contact(p[0] + move, p[1] + move, p[2] + move, capsule, Vec3::Zero()).distance;
      };
      EXPECT_NEAR(contact.normal[k], (distance(step) - distance(-step)) / (2 * h), 1e-3);
    }
  }
}

TEST(TriangleContact, WithoutAreaItIsItsEdges) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    Capsule capsule{random_point(random, 0.4), random_point(random, 0.4), 0.12};
    if (i % 7 == 0) capsule.b = capsule.a;
    std::array<Vec3, 3> p = {random_point(random, 0.4), random_point(random, 0.4), random_point(random, 0.4)};
    switch (i % 5) {
    case 0: p[2] = p[1]; break;
    case 1: p[0] = p[1] = p[2]; break;
    case 2: p[2] = 0.3 * p[0] + 0.7 * p[1]; break;
    case 3: p[2] = p[0] + 1e-9 * random_point(random, 1.0); break; // a sliver, but a triangle
    case 4: p[1] = p[0] + Vec3::Constant(1e-200); break;           // vanishes when squared
    }
    const FeatureContact contact = triangle_contact(p[0], p[1], p[2], capsule, Vec3::UnitY());
    expect_promises(contact, p, capsule);
    EXPECT_NEAR(contact.distance, search_triangle(p, capsule).distance, 1e-7) << i;
  }
}

TEST(TriangleContact, CrossedItIsPushedBackWhereItWas) {
  std::mt19937_64 random(6);
  int crossings = 0;
  for (int i = 0; i < 3000; ++i) {
    const Capsule capsule{random_point(random, 0.4), random_point(random, 0.4), 0.12};
    const std::array<Vec3, 3> p = {random_point(random, 0.4), random_point(random, 0.4), random_point(random, 0.4)};
    const Vec3 side = random_point(random, 1.0), n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    const FeatureContact contact = triangle_contact(p[0], p[1], p[2], capsule, side);
    if (contact.feature != ClothFeature::crossing) continue;
    ++crossings;
    EXPECT_GT(contact.normal.dot(side), 0.0);
    EXPECT_NEAR(std::abs(contact.normal.dot(n)), 1.0, 1e-12);
    EXPECT_GT(triangle_contact(p[0], p[1], p[2], capsule, Vec3::Zero()).normal.dot(n), 0.0) << "by its winding";
    // Pushed on and on it comes out on that side.
    Vec3 push = Vec3::Zero();
    FeatureContact now = contact;
    for (int k = 0; k < 200 && now.distance < -1e-9; ++k) {
      push -= now.distance * now.normal;
      now = triangle_contact(p[0] + push, p[1] + push, p[2] + push, capsule, side);
    }
    EXPECT_GE(now.distance, -1e-9);
    EXPECT_GT(push.dot(contact.normal), 0.0);
  }
  EXPECT_GT(crossings, 200);
}

TEST(FeatureContact, NormalWhereTheyMeetIsSane) {
  const Capsule limb{{-1, 0, 0}, {1, 0, 0}, 0.1}, ball{Vec3::Zero(), Vec3::Zero(), 0.1};
  const Vec3 up = Vec3::UnitY(), z = Vec3::UnitZ();
  const auto edge_normal = [](const Vec3& p, const Vec3& q, const Capsule& capsule, const Vec3& side) {
    const FeatureContact contact = edge_contact(p, q, capsule, side);
    EXPECT_EQ(contact.feature, ClothFeature::crossing);
    EXPECT_EQ(contact.distance, -0.1);
    expect_promises(contact, {p, q, Vec3::Zero()}, capsule);
    return contact.normal;
  };
  EXPECT_EQ(edge_normal(-z, z, limb, Vec3(0.9, 0.1, 0)), up);                    // perpendicular to both, on the side
  EXPECT_EQ(edge_normal(-z, z, limb, Vec3(0.9, -0.1, 0)), Vec3(-up));            //
  EXPECT_EQ(edge_normal({-2, 0, 0}, {3, 0, 0}, limb, Vec3(5, 0, -2)), Vec3(-z)); // along the axis
  EXPECT_EQ(edge_normal({-2, 0, 0}, {3, 0, 0}, limb, Vec3::Zero()), up);
  EXPECT_EQ(edge_normal(-z, z, ball, Vec3(3, 0, 7)), Vec3::UnitX());          // across the edge
  EXPECT_EQ(edge_normal(Vec3::Zero(), Vec3::Zero(), ball, -2 * z), Vec3(-z)); // a point on a point
  EXPECT_EQ(edge_normal(Vec3::Zero(), Vec3::Zero(), ball, Vec3::Zero()), up);
  const FeatureContact lying = triangle_contact({-3, 0, -3}, {3, 0, -3}, {0, 0, 3}, limb, Vec3(1, -0.2, 0));
  EXPECT_EQ(lying.feature, ClothFeature::crossing); // the axis lies in the triangle
  EXPECT_EQ(lying.normal, Vec3(-up));
  const FeatureContact flat = triangle_contact({0, 0, -3}, {0, 0, 0}, {0, 0, 3}, limb, Vec3(0, -0.2, 0));
  EXPECT_EQ(flat.feature, ClothFeature::crossing);
  EXPECT_EQ(flat.normal, Vec3(-up));
}

} // namespace
