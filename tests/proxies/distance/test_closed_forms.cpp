// The forms that only vectors use, in double: the rest is tested through what is built on them.
#include "proxies/distance/closed_forms.h"

#include "tests/support/collider_scenes.h"
#include "tests/support/nearest_search.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::proxies;
using tutu::test::random_point;

namespace {

TEST(ClosedForms, SegmentsAreWhereASearchFindsThem) {
  std::mt19937_64 random(1);
  int within = 0;
  constexpr int k_cases = 3000;
  for (int i = 0; i < k_cases; ++i) {
    Capsule capsule{random_point(random, 0.3), random_point(random, 0.3), 0.1};
    if (i % 5 == 0) capsule.b = capsule.a;
    const Vec3 p = random_point(random, 0.3), q = random_point(random, 0.3), edge = q - p;
    const PlainCone cone = round_cone(capsule);
    const auto [s, t] = PlainForms::nearest_of_segments(cone, edge, p - cone.a, edge.squaredNorm());
    const test::Searched twin = test::search_edge(p, q, capsule);
    EXPECT_NEAR((p + s * edge - cone.a - t * cone.axis).norm() - 0.1, twin.distance, 1e-12) << i;
    within += s > 0.0 && s < 1.0;
  }
  EXPECT_GT(within, 0.3 * k_cases);
  EXPECT_LT(within, 0.7 * k_cases);
}

TEST(ClosedForms, NearlyParallelSegmentsMissByTheirSineAtMost) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = random_point(random, 0.3), axis = random_point(random, 0.5);
    const Capsule capsule{a, a + axis, 0.1};
    const Vec3 p = a + 0.2 * axis + 0.2 * random_point(random, 0.5);
    const Vec3 q = p + (i % 2 ? 0.5 : -0.5) * axis + std::pow(10.0, -3 - i % 12) * random_point(random, 0.5);
    const Vec3 edge = q - p;
    const auto [s, t] = PlainForms::nearest_of_segments(round_cone(capsule), edge, p - a, edge.squaredNorm());
    EXPECT_NEAR((p + s * edge - a - t * axis).norm() - 0.1, test::search_edge(p, q, capsule).distance, 1e-6) << i;
  }
}

TEST(ClosedForms, TheFootOnAPlaneIsPerpendicular) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 e = random_point(random, 0.3), f = random_point(random, 0.3), r = random_point(random, 0.5);
    const auto [u, v, w] = PlainForms::foot_on_plane(e, f, r, 1e-200);
    const Vec3 away = r - v * e - w * f;
    EXPECT_NEAR(u + v + w, 1.0, 1e-12 * (std::abs(v) + std::abs(w)));
    const double lost = 1e-15 * e.squaredNorm() * f.squaredNorm() / e.cross(f).squaredNorm(); // of a sliver's digits
    EXPECT_NEAR(away.dot(e), 0.0, lost);
    EXPECT_NEAR(away.dot(f), 0.0, lost);
  }
}

} // namespace
