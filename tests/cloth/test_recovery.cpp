#include "cloth/mass_spring.h"
#include "cloth/metrics.h"
#include "cloth/recovery.h"
#include "cloth/xpbd.h"

#include <functional>
#include <gtest/gtest.h>
#include <random>

using namespace tutu;
using namespace tutu::cloth;

namespace {

/// What a stub saw of one step.
struct Seen {
  int substeps = 0;
  double position = 0.0, velocity = 0.0; ///< of the particle, at the start
};

const Garment& patch() {
  static const Garment garment = [] {
    GarmentDescription description;
    description.file = "patch";
    description.shape = GridShape{2, 2, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    return build_garment(description);
  }();
  return garment;
}

/// All particles of the patch at `x`, with a velocity of `v`.
Particles patch_at(double x, double v) {
  return {std::vector<Vec3>(4, Vec3(x, 0, 0)), std::vector<Vec3>(4, Vec3(v, 0, 0))};
}

/// A patch whose first particle moves by 1 a frame, and ruins itself in the first `bad` steps.
class Stub final : public Solver {
public:
  Stub(int bad, std::vector<Seen>& seen) : bad_(bad), seen_(&seen) { restore(patch_at(0, 0)); }

  void reset(std::span<const Vec3> positions) override {
    particles_.positions.assign(positions.begin(), positions.end());
    particles_.velocities.assign(positions.size(), Vec3::Zero());
  }
  void restore(const Particles& state) override { particles_ = state; }
  std::optional<Unfinished> step(const FrameInput& input, proxies::CollisionQuery&) override {
    seen_->push_back({input.substeps, particles_.positions[0].x(), particles_.velocities[0].x()});
    particles_.velocities[0].x() = 60.0;
    particles_.positions[0].x() += 1.0;
    if (bad_ == 0) return std::nullopt;
    --bad_;
    particles_.positions[0].x() = std::nan("");
    Divergence divergence;
    divergence.substep = 3;
    divergence.particle = static_cast<int>(seen_->size());
    return divergence;
  }
  const Particles& particles() const override { return particles_; }
  const SolverTimes& times() const override { return times_; }
  ContactCounts contact_counts() const override { return counts_; }

private:
  int bad_;
  std::vector<Seen>* seen_;
  Particles particles_;
  SolverTimes times_{1.0, 2.0, 4.0};
  ContactCounts counts_;
};

const std::unique_ptr<proxies::CollisionQuery>& brute() {
  static const auto query = proxies::make_query(proxies::Backend::brute);
  return query;
}

FrameInput ten_substeps() {
  FrameInput input;
  input.substeps = 10;
  return input;
}

TEST(Recovery, GoodFramesAreLeftAlone) {
  std::vector<Seen> seen;
  GuardedSolver cloth(std::make_unique<Stub>(0, seen), patch());
  for (int f = 0; f < 3; ++f) ASSERT_FALSE(cloth.step(ten_substeps(), *brute()).has_value());
  ASSERT_EQ(seen.size(), 3u);
  for (const Seen& step : seen) EXPECT_EQ(step.substeps, 10);
  EXPECT_FALSE(cloth.recovery().has_value());
  EXPECT_EQ(cloth.particles().positions[0].x(), 3.0);
}

TEST(Recovery, ABadFrameIsTakenAgainFromItsStartWithTwiceTheSubsteps) {
  std::vector<Seen> seen;
  GuardedSolver cloth(std::make_unique<Stub>(2, seen), patch());
  cloth.restore(patch_at(7, 5));
  ASSERT_FALSE(cloth.step(ten_substeps(), *brute()).has_value());
  ASSERT_EQ(seen.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(seen[k].substeps, 10 << k);
    EXPECT_EQ(seen[k].position, 7.0);
    EXPECT_EQ(seen[k].velocity, 5.0) << "motion is kept while small steps may do";
  }
  ASSERT_TRUE(cloth.recovery().has_value());
  EXPECT_TRUE(cloth.recovery()->carried);
  EXPECT_FALSE(cloth.recovery()->at_rest);
  EXPECT_EQ(cloth.recovery()->divergence.particle, 1) << "what was found first, not last";
  EXPECT_EQ(cloth.recovery()->first_substeps, 10);
  EXPECT_EQ(cloth.recovery()->tries, 2);
  EXPECT_EQ(cloth.recovery()->substeps, 40);
  EXPECT_EQ(cloth.times().cloth, 3 * 2.0) << "tries that failed cost time too";
  EXPECT_EQ(cloth.particles().positions[0].x(), 8.0);
}

TEST(Recovery, TheLastTryBeginsAtRest) {
  std::vector<Seen> seen;
  GuardedSolver cloth(std::make_unique<Stub>(1 + k_recovery_tries, seen), patch());
  cloth.restore(patch_at(7, 5));
  ASSERT_FALSE(cloth.step(ten_substeps(), *brute()).has_value());
  ASSERT_EQ(seen.size(), 2u + k_recovery_tries);
  for (int k = 0; k <= 1 + k_recovery_tries; ++k) {
    EXPECT_EQ(seen[k].position, 7.0);
    EXPECT_EQ(seen[k].velocity, k > k_recovery_tries ? 0.0 : 5.0) << k;
    EXPECT_EQ(seen[k].substeps, 10 << std::min(k, k_recovery_tries)) << k;
  }
  EXPECT_TRUE(cloth.recovery()->at_rest);
}

TEST(Recovery, ClothThatMustBeStoppedInEveryFrameIsAFailure) {
  // Diverges in every step but those from rest.
  class Restless final : public Solver {
  public:
    void reset(std::span<const Vec3> positions) override {
      restore({{positions.begin(), positions.end()}, std::vector<Vec3>(4, Vec3::Zero())});
    }
    void restore(const Particles& state) override { particles_ = state; }
    std::optional<Unfinished> step(const FrameInput&, proxies::CollisionQuery&) override {
      const bool moving = particles_.velocities[0].x() != 0.0;
      particles_.velocities[0].x() = 1.0;
      return moving ? std::optional<Unfinished>(Divergence{}) : std::nullopt;
    }
    const Particles& particles() const override { return particles_; }
    const SolverTimes& times() const override { return times_; }
    ContactCounts contact_counts() const override { return counts_; }

  private:
    Particles particles_ = patch_at(0, 0);
    SolverTimes times_;
    ContactCounts counts_;
  };
  GuardedSolver cloth(std::make_unique<Restless>(), patch());
  EXPECT_FALSE(cloth.step(ten_substeps(), *brute()).has_value()) << "it begins at rest";
  for (int f = 1; f < k_stops_in_a_row; ++f) ASSERT_FALSE(cloth.step(ten_substeps(), *brute()).has_value()) << f;
  EXPECT_TRUE(divergence_of(cloth.step(ten_substeps(), *brute())));
  EXPECT_TRUE(cloth.recovery()->worn_out);
}

TEST(Recovery, AfterTheLastTryItFailsWithTheFirstDivergenceAndTheLastGoodState) {
  std::vector<Seen> seen;
  GuardedSolver cloth(std::make_unique<Stub>(1000, seen), patch());
  const auto result = cloth.step(ten_substeps(), *brute());
  ASSERT_TRUE(divergence_of(result));
  EXPECT_EQ(divergence_of(result)->particle, 1);
  EXPECT_EQ(seen.size(), 2u + k_recovery_tries);
  EXPECT_FALSE(cloth.recovery()->carried);
  EXPECT_FALSE(cloth.recovery()->worn_out);
  EXPECT_EQ(cloth.particles().positions[0].x(), 0.0);
  // A reset makes a new beginning.
  cloth.reset(patch_at(2, 0).positions);
  EXPECT_FALSE(cloth.recovery().has_value());
  cloth.step(ten_substeps(), *brute());
  EXPECT_EQ(seen[2 + k_recovery_tries].substeps, 10);
}

TEST(Recovery, CautionStaysAWhileAndThenGoes) {
  std::vector<Seen> seen;
  GuardedSolver cloth(std::make_unique<Stub>(2, seen), patch());
  for (int f = 0; f < 1 + 2 * k_calm_frames + 1; ++f) ASSERT_FALSE(cloth.step(ten_substeps(), *brute()).has_value());
  const std::size_t after = 3; // steps of the first frame
  EXPECT_EQ(seen[after].substeps, 40);
  EXPECT_EQ(seen[after + k_calm_frames - 1].substeps, 40);
  EXPECT_EQ(seen[after + k_calm_frames].substeps, 20);
  EXPECT_EQ(seen[after + 2 * k_calm_frames].substeps, 10);
}

Garment hanging_sheet(double stretch) {
  GarmentDescription description;
  description.file = "sheet";
  description.shape = GridShape{12, 12, {-0.25, 1, 0}, {0.5, 0, 0}, {0, 0, 0.5}};
  description.fabric.stretch = stretch;
  description.attachments = {{"Hips", 0, 0, 0, -1}};
  return build_garment(description);
}

struct Outcome {
  int recoveries = 0;
  std::uint64_t hash = 0;
  double stretch = 0.0; ///< p99 of the lengthening, in the end
};

Outcome swing(const Garment& garment, const std::function<std::unique_ptr<Solver>()>& make, int substeps, int frames) {
  GuardedSolver cloth(make(), garment);
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  FrameInput input;
  input.pins_start = input.pins_end = pins;
  input.substeps = substeps;
  Outcome outcome;
  for (int f = 0; f < frames; ++f) {
    EXPECT_FALSE(cloth.step(input, *brute()).has_value()) << "frame " << f;
    outcome.recoveries += cloth.recovery().has_value();
  }
  std::vector<double> lengthening = strains_of(garment, cloth.particles());
  for (double& s : lengthening) s = std::max(0.0, s);
  outcome.stretch = spread(std::move(lengthening)).p99;
  outcome.hash = state_hash(cloth.particles());
  return outcome;
}

TEST(Recovery, MassSpringAtTooFewSubstepsHelpsItself) {
  const Garment garment = hanging_sheet(2000.0);
  const auto make = [&] { return std::make_unique<MassSpring>(garment); };
  const Outcome first = swing(garment, make, 5, 240);
  EXPECT_GT(first.recoveries, 0) << "else this shows nothing";
  EXPECT_LT(first.recoveries, 20) << "caution: not every frame is met unprepared";
  EXPECT_LT(first.stretch, 0.05);
  const Outcome again = swing(garment, make, 5, 240);
  EXPECT_EQ(first.hash, again.hash);
  EXPECT_EQ(first.recoveries, again.recoveries);
}

TEST(Recovery, WhatHoldsIsNotTouchedToTheBit) {
  const Garment garment = hanging_sheet(200.0);
  const Outcome guarded = swing(
      garment, [&] { return make_xpbd(garment, {}); }, 10, 60);
  EXPECT_EQ(guarded.recoveries, 0);
  const std::unique_ptr<Solver> owner = make_xpbd(garment, {});
  Solver& bare = *owner;
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  FrameInput input = ten_substeps();
  input.pins_start = input.pins_end = pins;
  for (int f = 0; f < 60; ++f) ASSERT_FALSE(bare.step(input, *brute()).has_value());
  EXPECT_EQ(state_hash(bare.particles()), guarded.hash);
}

TEST(Recovery, PinsAndCollidersThatAreNoNumbersFailAtOnce) {
  const Garment garment = hanging_sheet(40.0);
  GuardedSolver cloth(make_xpbd(garment, {}), garment);
  const std::uint64_t before = state_hash(cloth.particles());
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  std::vector<Vec3> bad = pins;
  bad[3].y() = std::nan("");
  FrameInput input = ten_substeps();
  input.pins_start = pins;
  input.pins_end = bad;
  const auto result = cloth.step(input, *brute());
  ASSERT_TRUE(divergence_of(result));
  EXPECT_EQ(divergence_of(result)->particle, garment.pins[3].particle);
  EXPECT_FALSE(cloth.recovery()->carried);
  input.pins_end = pins;
  const std::vector<proxies::Capsule> here = {{{0, 0, 0}, {1, 0, 0}, 0.1}},
                                      nowhere = {{{0, std::nan(""), 0}, {1, 0, 0}, 0.1}};
  input.colliders = {here, nowhere, std::nullopt};
  EXPECT_TRUE(cloth.step(input, *brute()).has_value());
  EXPECT_EQ(state_hash(cloth.particles()), before);
  input.colliders = {here, here, std::nullopt};
  EXPECT_FALSE(cloth.step(input, *brute()).has_value());
}

TEST(Recovery, EdgesAreDrawnInFromAnywhere) {
  const Garment garment = hanging_sheet(40.0);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
  std::vector<Vec3> positions = garment.rest_positions;
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!pinned[i]) positions[i] = Vec3(anywhere(random), 1.0 + anywhere(random), anywhere(random));
  draw_in_edges(garment, positions);
  Particles particles{positions, {}};
  EXPECT_LE(spread(strains_of(garment, particles)).max, k_mended_stretch + 1e-9);
  for (const Pin& pin : garment.pins) EXPECT_EQ(positions[pin.particle], garment.rest_positions[pin.particle]);
  // What needs no mending is left alone to the bit.
  std::vector<Vec3> fine = garment.rest_positions;
  draw_in_edges(garment, fine);
  EXPECT_EQ(fine, garment.rest_positions);
}

} // namespace
