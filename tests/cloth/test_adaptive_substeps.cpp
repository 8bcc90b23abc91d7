#include "cloth/adaptive_substeps.h"
#include "cloth/state/tolerances.h"
#include "proxies/distance/signed_distance.h"
#include "tests/support/collider_scenes.h"

#include <gmock/gmock.h>
#include <numbers>

using namespace tutu;
using namespace tutu::cloth;
using proxies::Capsule;

namespace {

constexpr double k_offset = 0.002;

/// A limb along x beside a garment of half a metre about the origin.
struct Limb {
  std::vector<Capsule> start, end;

  explicit Limb(const Vec3& motion, const Vec3& at = Vec3::Zero(), double radius = 0.06) {
    start = {{at - Vec3(0.3, 0, 0), at + Vec3(0.3, 0, 0), radius}};
    end = {{start[0].a + motion, start[0].b + motion, radius}};
  }
  FrameInput input(int substeps) const {
    FrameInput input;
    input.substeps = substeps;
    input.colliders = {start, end, std::nullopt};
    return input;
  }
};

Extent half_metre(double fastest = 0.0) { return {Vec3::Constant(-0.25), Vec3::Constant(0.25), fastest}; }

TEST(AdaptiveSubsteps, WhatIsSafeIsLeftAsAsked) {
  const Limb limb(Vec3(0, 0, 0.05));
  const SubstepPlan plan = plan_substeps(limb.input(10), half_metre(), k_offset);
  EXPECT_EQ(plan.substeps, 10);
  EXPECT_EQ(plan.collider, -1);
  EXPECT_FALSE(plan.split(10));
}

TEST(AdaptiveSubsteps, AFastLimbGetsAsManyAsItsWayNeeds) {
  const Limb limb(Vec3(0, 0, 0.5)); // 30 m/s
  const SubstepPlan plan = plan_substeps(limb.input(10), half_metre(), k_offset);
  EXPECT_EQ(plan.substeps, static_cast<int>(std::ceil(0.5 / (k_safe_share * 0.062))));
  EXPECT_EQ(plan.collider, 0);
  EXPECT_DOUBLE_EQ(plan.collider_way, 0.5);
  EXPECT_LE((plan.collider_way + plan.cloth_way) / plan.substeps, plan.safe_way);
  EXPECT_THAT(plan.reason("leg"), ::testing::HasSubstr("leg moves 0.5 m"));
}

TEST(AdaptiveSubsteps, TheClothsOwnSpeedAndThePinsCount) {
  const Limb still(Vec3::Zero());
  const SubstepPlan falling = plan_substeps(still.input(2), half_metre(12.0), k_offset);
  EXPECT_EQ(falling.substeps, static_cast<int>(std::ceil(12.0 / 60.0 / (k_safe_share * 0.062))));
  const std::vector<Vec3> from = {Vec3::Zero()}, to = {Vec3(0.3, 0, 0)};
  FrameInput input = still.input(2);
  input.pins_start = from;
  input.pins_end = to;
  EXPECT_EQ(plan_substeps(input, half_metre(), k_offset).substeps,
            static_cast<int>(std::ceil(0.3 / (k_safe_share * 0.062))));
}

TEST(AdaptiveSubsteps, WhatPassesFarAwayCostsNothing) {
  const Limb passing(Vec3(0, 0, 0.5), Vec3(0, 0.5, 0));
  EXPECT_EQ(plan_substeps(passing.input(10), half_metre(), k_offset).substeps, 10);
  const Limb arriving(Vec3(0, -0.5, 0), Vec3(0, 0.5, 0));
  EXPECT_GT(plan_substeps(arriving.input(10), half_metre(), k_offset).substeps, 10);
  // Cloth that flies to where the limb passes.
  EXPECT_GT(plan_substeps(passing.input(10), half_metre(15.0), k_offset).substeps, 10);
}

TEST(AdaptiveSubsteps, TheThinAndFastestDecides) {
  std::vector<Capsule> start = {{{-0.1, 0, 0}, {0.1, 0, 0}, 0.10}, {{-0.1, 0, 0.1}, {0.1, 0, 0.1}, 0.02}};
  std::vector<Capsule> end = start;
  for (Capsule& c : end) c = {c.a + Vec3(0, 0.3, 0), c.b + Vec3(0, 0.3, 0), c.radius};
  FrameInput input;
  input.substeps = 3;
  input.colliders = {start, end, std::nullopt};
  EXPECT_EQ(plan_substeps(input, half_metre(), k_offset).collider, 1);
}

TEST(AdaptiveSubsteps, AJumpIsBounded) {
  const Limb jump(Vec3(5, 0, 0));
  const SubstepPlan plan = plan_substeps(jump.input(10), half_metre(300.0), k_offset);
  EXPECT_EQ(plan.substeps, k_most_adaptive_substeps);
  EXPECT_TRUE(plan.bounded);
  EXPECT_EQ(plan_substeps(jump.input(500), half_metre(300.0), k_offset).substeps, 500) << "never fewer than asked";
}

TEST(AdaptiveSubsteps, ATurnIsMeasuredAlongItsArc) {
  Limb kick(Vec3::Zero());
  const double turn = 2.0 * std::numbers::pi / 3.0;
  kick.start = {{{0, 0, 0}, {0.5, 0, 0}, 0.06}};
  kick.end = {{{0, 0, 0}, {0.5 * std::cos(turn), 0.5 * std::sin(turn), 0}, 0.06}};
  const std::vector<Vec3> spin = {Vec3(0, 0, turn)};
  FrameInput input = kick.input(1);
  input.colliders.spin = spin;
  EXPECT_NEAR(plan_substeps(input, half_metre(), k_offset).collider_way, 0.5 * turn, 1e-12);
}

TEST(AdaptiveSubsteps, NoParticleChangesSidesWithinASafeSubstep) {
  // The promise itself: at random, a particle outside a capsule before a substep is, after it, still on the near side
  // of the axis, and its normal pushes it back to where it came from.
  std::mt19937_64 random(11);
  int near_misses = 0;
  for (int trial = 0; trial < 60000; ++trial) {
    test::ColliderScene scene = test::random_scene(random, 1, 1, 0.5);
    FrameInput input;
    input.substeps = 1;
    input.colliders = scene.swept();
    const double speed = 5.0;
    const Vec3 way = test::random_point(random, speed / 60.0 / std::sqrt(3.0));
    const Extent extent{scene.points[0], scene.points[0], speed};
    const SubstepPlan plan = plan_substeps(input, extent, k_offset);
    for (int k = 0; k < plan.substeps; ++k) {
      const Capsule before = scene.at(static_cast<double>(k) / plan.substeps)[0];
      const Capsule after = scene.at(static_cast<double>(k + 1) / plan.substeps)[0];
      const Vec3 p = scene.points[0] + way * (static_cast<double>(k) / plan.substeps);
      const Vec3 q = scene.points[0] + way * (static_cast<double>(k + 1) / plan.substeps);
      const proxies::Contact was = proxies::signed_distance(p, before);
      if (was.distance < k_offset) break; // inside: from here on the solver would push
      const proxies::Contact is = proxies::signed_distance(q, after);
      if (is.distance >= 0.0) continue;
      ++near_misses;
      ASSERT_GT(is.normal.dot(was.normal), 0.0) << "trial " << trial << ", substep " << k;
    }
  }
  EXPECT_GT(near_misses, 200);
}

} // namespace
