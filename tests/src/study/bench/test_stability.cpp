// What must never happen to cloth, and what it must come back from. Ten uneven starts of each scene, default
// settings.
#include "src/study/bench/stability_run.h"
#include "tests/support/mesh_sheet.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;

namespace {

/// All of a variant's starts must keep its limits; a failure names each start that does not.
void expect_all_pass(const std::function<StabilityScene(std::uint64_t)>& build) {
  int passed = 0;
  std::string name;
  for (int seed = 1; seed <= k_stability_runs; ++seed) {
    const StabilityScene scene = build(seed);
    name = scene.name;
    const std::vector<std::string> broken = broken_limits(scene, run_stability(scene, {}));
    passed += broken.empty();
    EXPECT_TRUE(broken.empty()) << scene.name << ", start " << seed << ": "
                                << fmt::format("{}", fmt::join(broken, "; "));
  }
  EXPECT_EQ(passed, k_stability_runs) << name;
}

/// The scene with its sheet of other triangles, held along the same border.
StabilityScene of_mesh(StabilityScene scene, const cloth::MeshShape& mesh) {
  cloth::GarmentDescription description;
  description.name = "mesh";
  description.shape = mesh;
  description.fabric = scene.garment.fabric;
  double top = -1e9;
  for (const Vec3& p : mesh.positions) top = std::max(top, p.y());
  cloth::Attachment upper;
  upper.joint = "stage";
  upper.above = top - 1e-6;
  description.attachments = {upper};
  scene.garment = cloth::build_garment(description);
  scene.start = scene.garment.rest_positions;
  std::vector<Vec3> held;
  for (const cloth::Pin& pin : scene.garment.pins) held.push_back(scene.garment.rest_positions[pin.particle]);
  scene.pose = [grid = scene.pose, held](double t, std::vector<proxies::Capsule>& capsules, std::vector<Vec3>& pins) {
    grid(t, capsules, pins);
    pins = held;
  };
  return scene;
}

class FastLeg : public ::testing::TestWithParam<double> {};
TEST_P(FastLeg, NothingPasses_slow) {
  expect_all_pass([](std::uint64_t seed) { return fast_leg(GetParam(), seed); });
}
INSTANTIATE_TEST_SUITE_P(Stability, FastLeg, ::testing::Values(1, 2, 5, 10, 20, 30));

// As thin as a hand: it fits between the corners of a cell that a blow tears apart.
class ThinLeg : public ::testing::TestWithParam<double> {};
TEST_P(ThinLeg, NothingPasses_slow) {
  for (const double thickness : {0.004, 0.008, 0.016, 0.032})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const StabilityScene scene = fast_leg(app::FastLeg{GetParam(), 0.012, thickness}, seed);
      const StabilityRun run = run_stability(scene, {});
      EXPECT_EQ(run.crossings, 0) << scene.name << ", " << thickness << " m, start " << seed;
      EXPECT_EQ(run.pierced, 0) << scene.name << ", " << thickness << " m, start " << seed;
      EXPECT_TRUE(run.failure.empty()) << run.failure;
    }
}
INSTANTIATE_TEST_SUITE_P(Stability, ThinLeg, ::testing::Values(1, 3, 7, 10, 14, 20, 30));

TEST(Stability, AdaptiveSubstepsAreWhatStopsAFastLeg_slow) {
  RunSettings setup;
  setup.substeps = 3;
  setup.features = cloth::ContactFeatures::particles; // and no other help
  setup.swept = false;
  for (const double speed : {1.0, 10.0, 30.0}) {
    const StabilityScene scene = fast_leg(speed, 1);
    setup.adaptive_substeps = true;
    EXPECT_EQ(run_stability(scene, setup).crossings, 0) << speed;
    setup.adaptive_substeps = false;
    const StabilityRun fixed = run_stability(scene, setup);
    EXPECT_EQ(fixed.most_substeps, 3) << "a fixed cost";
    EXPECT_EQ(fixed.crossings > 0, speed >= 10.0) << speed;
  }
}

class CoarseCells : public ::testing::TestWithParam<std::tuple<int, bool>> {};
TEST_P(CoarseCells, NothingPasses_slow) {
  const auto [cells, along] = GetParam();
  expect_all_pass([&](std::uint64_t seed) { return coarse_cells(cells, along, seed); });
}
INSTANTIATE_TEST_SUITE_P(Stability, CoarseCells, ::testing::Combine(::testing::Range(1, 7), ::testing::Bool()));

TEST(Stability, AnArmInTheWallWithItsAxisWithinComesFree_slow) {
  expect_all_pass([](std::uint64_t seed) { return start_inside(true, seed); });
}
TEST(Stability, AnArmInTheWallWithItsAxisOutsideComesFree_slow) {
  expect_all_pass([](std::uint64_t seed) { return start_inside(false, seed); });
}
TEST(Stability, AToldTeleportIsNoEvent_slow) {
  expect_all_pass([](std::uint64_t seed) { return teleport(true, seed); });
}
TEST(Stability, AnUntoldTeleportIsRecoveredFrom_slow) {
  expect_all_pass([](std::uint64_t seed) { return teleport(false, seed); });
}
TEST(Stability, RandomPositionsAreRecoveredFrom_slow) { expect_all_pass(randomised); }
TEST(Stability, ATubePressedFlatUprightOpensAgain_slow) {
  expect_all_pass([](std::uint64_t seed) { return flattened(true, seed); });
}
TEST(Stability, ATubePressedFlatLevelFallsOpen_slow) {
  expect_all_pass([](std::uint64_t seed) { return flattened(false, seed); });
}
TEST(Stability, ATwistedTubeUntwists_slow) { expect_all_pass(twist); }
TEST(Stability, AFunnelHoldsWhatFallsIn_slow) { expect_all_pass(funnel); }
TEST(Stability, ATurningBallTakesClothAlongByFriction_slow) {
  expect_all_pass([](std::uint64_t seed) { return rotating_sphere(0.8, seed); });
}
TEST(Stability, ATurningBallWithoutFrictionDoesNot_slow) {
  expect_all_pass([](std::uint64_t seed) { return rotating_sphere(0.0, seed); });
}

TEST(Stability, RunsAreRepeatableToTheBit) {
  const StabilityScene scene = fast_leg(20.0, 3), again = fast_leg(20.0, 3), other = fast_leg(20.0, 4);
  const std::uint64_t hash = cloth::state_hash(run_stability(scene, {}).end);
  EXPECT_EQ(hash, cloth::state_hash(run_stability(again, {}).end));
  EXPECT_NE(hash, cloth::state_hash(run_stability(other, {}).end)) << "the seed must matter";
}

TEST(Stability, SweptContactsStopAFastLegAtAFixedCost_slow) {
  RunSettings setup;
  setup.substeps = 3;
  setup.adaptive_substeps = false;
  for (const double speed : {10.0, 20.0, 30.0}) {
    int without = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const StabilityScene scene = fast_leg(speed, seed);
      setup.swept = true;
      EXPECT_EQ(run_stability(scene, setup).crossings, 0) << speed << " m/s, start " << seed;
      setup.swept = false;
      without += run_stability(scene, setup).crossings;
    }
    EXPECT_GT(without, 0) << speed << " m/s is too slow to show anything";
  }
}

TEST(Stability, TheJudgeSeesALegThatPassesThroughAMesh) {
  StabilityScene scene =
      of_mesh(fast_leg(2.0, 1), test::mesh_sheet(16, {-0.3, 1.6, 0}, {0.6, 0, 0}, {0, -0.6, 0}, 0.2));
  scene.pose = [thick = scene.pose](double t, std::vector<proxies::Capsule>& capsules, std::vector<Vec3>& pins) {
    thick(t, capsules, pins);
    capsules[0].radius = 1e-6;
  };
  scene.seconds = 0.4;
  RunSettings setup;
  setup.swept = false;
  setup.adaptive_substeps = false;
  setup.features = cloth::ContactFeatures::particles;
  const StabilityRun run = run_stability(scene, setup);
  EXPECT_TRUE(run.failure.empty()) << run.failure;
  EXPECT_GE(run.crossings, 14);
  EXPECT_FALSE(broken_limits(scene, run).empty());
}

TEST(Stability, TheJudgeSeesALegThatPasses) {
  // A leg as thin as nothing goes between all particles.
  StabilityScene scene = fast_leg(2.0, 1);
  scene.pose = [thick = scene.pose](double t, std::vector<proxies::Capsule>& capsules, std::vector<Vec3>& pins) {
    thick(t, capsules, pins);
    capsules[0].radius = 1e-6;
  };
  RunSettings setup;
  setup.features = cloth::ContactFeatures::particles;
  setup.swept = false;
  setup.adaptive_substeps = false;
  StabilityRun run = run_stability(scene, setup);
  EXPECT_EQ(run.crossings, scene.garment.columns);
  EXPECT_FALSE(broken_limits(scene, run).empty());
  run = {};
  run.depth = std::nan("");
  EXPECT_EQ(broken_limits(scene, run).size(), 1u);
}

} // namespace
