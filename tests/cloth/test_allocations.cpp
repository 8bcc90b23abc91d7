// Nothing allocates in a step once it is warm: by counting.
#include "cloth/adaptive_substeps.h"
#include "cloth/contact/self_collision.h"
#include "cloth/recovery.h"
#include "tests/cloth/contact/two_layers.h"
#include "tests/support/counted_allocations.h"
#include "tests/support/swinging_limbs.h"
#include "tests/support/woven_cases.h"

#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace tutu;
using test::allocations;
using namespace tutu::cloth;

/// A skirt in a periodic dance: warm after a few periods.
long allocations_of_a_warm_run(const SolverOptions& options, proxies::Backend backend, std::optional<double> seam) {
  Garment garment = test::detail::tube(24, seam ? 49 : 47, {}, 0.8, seam);
  test::pin_first_row(garment);
  GuardedSolver solver(make_solver(garment, options), garment);
  const auto query = proxies::make_query(backend);
  constexpr int k_period = 60; // frames
  test::SwingingLimbs limbs(garment, k_period);
  const auto run = [&](int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      FrameInput input = limbs.advance(8);
      input.substeps = plan_substeps(input, extent_of(solver.particles()), garment.fabric.contact_offset()).substeps;
      EXPECT_FALSE(solver.step(input, *query).has_value()) << frame;
    }
  };
  run(3 * k_period);
  const long before = allocations;
  run(k_period);
  return allocations - before;
}

TEST(SolverAllocations, NoneInAWarmRun_slow) {
  for (const ContactFeatures features :
       {ContactFeatures::automatic, ContactFeatures::particles, ContactFeatures::triangles})
    for (const bool precise : {false, true})
      for (const int passes : {1, 2}) {
        SolverOptions options;
        options.features = features;
        options.double_precision = precise;
        options.passes = passes;
        EXPECT_EQ(allocations_of_a_warm_run(options, proxies::Backend::hybrid, std::nullopt), 0)
            << k_contact_features_names[static_cast<std::size_t>(features)] << (precise ? ", double" : ", float");
      }
}

TEST(SolverAllocations, NoneWithSeamsAndOtherBackends) {
  SolverOptions options;
  EXPECT_EQ(allocations_of_a_warm_run(options, proxies::Backend::hybrid, 0.6), 0);
  EXPECT_EQ(allocations_of_a_warm_run(options, proxies::Backend::brute, 0.6), 0);
  options.solver = SolverKind::mass_spring;
  EXPECT_EQ(allocations_of_a_warm_run(options, proxies::Backend::hybrid, 0.6), 0);
}

TEST(Allocations, NoneInSelfCollisionOnceWarmedUp) {
  std::vector<Vec3> rest;
  const Garment garment = test::folded_sheet(20, 0.4, 175.0, {}, rest);
  SelfCollision self(garment);
  std::vector<Vec3> start = rest, now = rest;
  const auto cycle = [&] { // two layers breathe: apart, and into each other fast enough to be slowed
    for (int k = 0; k < 60; ++k) {
      start = now;
      for (std::size_t i = 0; i < now.size(); ++i)
        now[i] = rest[i] * (1.0 + 0.2 * std::sin(k * 0.1 * std::numbers::pi)) + Vec3(0.01 * k, 0, 0);
      ASSERT_TRUE(self.resolve(start, now, 1.0 / 600.0));
    }
    now = rest;
    self.forget();
  };
  cycle();
  const SelfCollisionCounts before = self.counts();
  const long allocated = allocations;
  for (int k = 0; k < 3; ++k) cycle();
  EXPECT_EQ(allocations - allocated, 0);
  EXPECT_GT(self.counts().contacts, before.contacts);
  EXPECT_GT(self.counts().slowed, before.slowed);
  EXPECT_GT(self.counts().searches, before.searches);
}

} // namespace
