#include "cloth/garment/springs.h"
#include "cloth/metrics.h"
#include "cloth/xpbd.h"

#include <array>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>
#include <random>

using namespace tutu;
using namespace tutu::cloth;

namespace {

/// An upright sheet, `size` m a side, whose first row may be held.
Garment sheet(int n, bool held, Fabric fabric = {}, Vec3 down = {0, -0.5, 0}) {
  GarmentDescription description;
  description.file = "sheet";
  description.shape = GridShape{n, n, {-0.25, 1, 0}, {0.5, 0, 0}, down};
  description.fabric = fabric;
  if (held) description.attachments = {{"Hips", 0, 0, 0, -1}};
  return build_garment(description);
}

/// Runs frames with the pins where they were at rest.
void run(Solver& solver, const Garment& garment, FrameInput input, int frames) {
  static const auto query = proxies::make_query(proxies::Backend::brute);
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  input.pins_start = input.pins_end = pins;
  for (int f = 0; f < frames; ++f) ASSERT_FALSE(solver.step(input, *query).has_value()) << f;
}

double kinetic_energy(const Garment& garment, const Particles& particles) {
  double energy = 0.0;
  for (int i = 0; i < garment.particle_count(); ++i)
    energy += 0.5 * garment.masses[i] * particles.velocities[i].squaredNorm();
  return energy;
}

/// Both precisions of the one source, each with the rounding it may show.
struct Precision {
  bool is_double;
  double rounding; ///< m, m/s
};
constexpr std::array<Precision, 2> k_precisions = {Precision{true, 1e-12}, Precision{false, 2e-5}};

TEST(Xpbd, FreeFallIsThatOfTheScheme) {
  Fabric fabric;
  fabric.drag = 0.0;
  const Garment garment = sheet(6, false, fabric);
  for (const Precision& precision : k_precisions) {
    const std::unique_ptr<Solver> cloth = make_xpbd(garment, {.double_precision = precision.is_double});
    FrameInput input;
    input.substeps = 7;
    run(*cloth, garment, input, 30);
    const double h = input.seconds / 7, n = 30 * 7;
    double worst = 0.0;
    for (int i = 0; i < garment.particle_count(); ++i) {
      const Vec3 fallen = cloth->particles().positions[i] - garment.rest_positions[i];
      worst = std::max(worst, (fallen - input.gravity * (h * h * n * (n + 1) / 2)).norm());
    }
    EXPECT_LT(worst, precision.rounding);
  }
}

TEST(Xpbd, ConstraintsKeepMomentumAndNeverAddEnergy) {
  Fabric fabric;
  fabric.drag = fabric.bend = fabric.bend_springs = 0.0; // the energy below is all there is
  const Garment garment = sheet(10, false, fabric);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> shift(-0.01, 0.01);
  std::vector<Vec3> shaken = garment.rest_positions;
  for (Vec3& p : shaken) p += Vec3(shift(random), shift(random), shift(random));
  for (const Precision& precision : k_precisions) {
    const std::unique_ptr<Solver> cloth = make_xpbd(garment, {.double_precision = precision.is_double});
    cloth->reset(shaken);
    FrameInput input;
    input.substeps = 10;
    input.gravity.setZero();
    const double start = elastic_energy(garment, shaken);
    double least = start;
    for (int f = 0; f < 60; ++f) {
      run(*cloth, garment, input, 1);
      const double now =
          elastic_energy(garment, cloth->particles().positions) + kinetic_energy(garment, cloth->particles());
      // Velocities are those of half a substep ago: what goes to and fro in springs shows a little as growth.
      EXPECT_LE(now, least + 1e-3 * start) << "frame " << f;
      least = std::min(least, now);
    }
    Vec3 momentum = Vec3::Zero();
    for (int i = 0; i < garment.particle_count(); ++i) momentum += garment.masses[i] * cloth->particles().velocities[i];
    EXPECT_LT(momentum.norm(), precision.rounding);
  }
}

TEST(Xpbd, ASheetHeldAtItsSideMovesAsOneHeldAtItsTop) {
  GarmentDescription by_side, by_top;
  by_side.shape = GridShape{7, 33, {0, 1, 0}, {0.6, 0, 0}, {0, 0, 0.2}};
  by_top.shape = GridShape{33, 7, {0, 1, 0}, {0, 0, 0.2}, {0.6, 0, 0}};
  by_side.attachments = {{"left", 0, -1, 0, 0}};
  by_top.attachments = {{"left", 0, 0, 0, -1}};
  const Garment side = build_garment(by_side), top = build_garment(by_top);
  const auto a = make_xpbd(side, {.double_precision = true}), b = make_xpbd(top, {.double_precision = true});
  FrameInput input;
  run(*a, side, input, 60);
  run(*b, top, input, 60);
  for (int row = 0; row < 7; ++row)
    for (int column = 0; column < 33; ++column)
      EXPECT_LT((a->particles().positions[row * 33 + column] - b->particles().positions[column * 7 + row]).norm(),
                1e-9);
}

TEST(Xpbd, AHangingSheetGivesByItsOwnWeightAndNoMore_slow) {
  // Strain at height s above the lower edge is rho g s / k; over the length L the sheet gives rho g L^2 / (2 k).
  Fabric fabric;
  fabric.density = 0.2;
  fabric.stretch = 60.0;
  fabric.shear = 0.01;
  fabric.bend_springs = 0.0;
  const double expected = fabric.density * 9.81 * 0.5 * 0.5 / (2.0 * fabric.stretch);
  for (const int n : {10, 20, 40})
    for (const int substeps : {5, 10, 20}) {
      const Garment garment = sheet(n, true, fabric);
      const std::unique_ptr<Solver> owner = make_xpbd(garment, {});
      Solver& cloth = *owner;
      FrameInput input;
      input.substeps = substeps;
      input.extra_drag = 5.0;
      run(cloth, garment, input, 240);
      double give = 0.0;
      for (int column = 0; column < n; ++column)
        give +=
            garment.rest_positions[(n - 1) * n + column].y() - cloth.particles().positions[(n - 1) * n + column].y();
      // The lumped last row is half a cell too high up: of the order of 1/n.
      EXPECT_NEAR(give / n, expected, expected * (0.03 + 0.5 / n)) << n << " rows, " << substeps << " substeps";
    }
}

TEST(Xpbd, StiffThreadsHoldAtAnyResolution) {
  Fabric fabric;
  fabric.stretch = 5000.0;
  for (const int n : {15, 60}) {
    const Garment garment = sheet(n, true, fabric);
    const std::unique_ptr<Solver> owner = make_xpbd(garment, {});
    Solver& cloth = *owner;
    FrameInput input;
    input.substeps = 10;
    run(cloth, garment, input, 120);
    EXPECT_LT(spread(strains_of(garment, cloth.particles())).max, 0.01) << n;
  }
}

/// A sheet laid on a slope of this angle; how far its middle has slid after `frames`, m.
double slide(double angle, double friction, int frames) {
  Fabric fabric;
  fabric.drag = 0.0;
  const Vec3 downhill(0.0, -std::sin(angle), std::cos(angle)), normal(0.0, std::cos(angle), std::sin(angle));
  Garment garment = sheet(8, false, fabric, 0.5 * downhill);
  const double offset = fabric.contact_offset();
  for (Vec3& p : garment.rest_positions) p += offset * normal - normal * normal.dot(Vec3(0, 1, 0));
  const std::unique_ptr<Solver> owner = make_xpbd(garment, {});
  Solver& cloth = *owner;
  FrameInput input;
  input.substeps = 10;
  input.colliders.ground = proxies::Plane{normal, 0.0};
  const std::vector<double> coefficients = {friction};
  input.friction = coefficients;
  run(cloth, garment, input, frames);
  Vec3 moved = Vec3::Zero();
  for (int i = 0; i < garment.particle_count(); ++i)
    moved += (cloth.particles().positions[i] - garment.rest_positions[i]) / garment.particle_count();
  return moved.dot(downhill);
}

TEST(Xpbd, FrictionHoldsUpToItsAngleAndSlidesBeyond) {
  const double half_degree = 0.5 * std::numbers::pi / 180.0;
  for (const double friction : {0.1, 0.3, 0.6, 1.0}) {
    const double angle = std::atan(friction);
    EXPECT_LT(slide(angle - half_degree, friction, 120), 1e-4) << friction;
    const double steep = angle + half_degree, seconds = 2.0;
    const double expected = 0.5 * 9.81 * (std::sin(steep) - friction * std::cos(steep)) * seconds * seconds;
    EXPECT_NEAR(slide(steep, friction, 120), expected, 0.05 * expected + 1e-3) << friction;
  }
}

TEST(Xpbd, FrictionFollowsTheMovingSurface) {
  // A sheet on a broad capsule that moves sideways goes with it; without friction it stays behind.
  const Garment garment = sheet(8, false, {}, {0, 0, 0.2});
  const auto query = proxies::make_query(proxies::Backend::brute);
  for (const double friction : {0.0, 1.0}) {
    const std::unique_ptr<Solver> owner = make_xpbd(garment, {});
    Solver& cloth = *owner;
    const std::vector<double> coefficients = {friction};
    double x = 0.0;
    for (int f = 0; f < 60; ++f) {
      const double next = x + 0.2 / 60.0;
      const std::vector<proxies::Capsule> start = {{{x - 3, 0, 0.1}, {x + 3, 0, 0.1}, 0.999}};
      const std::vector<proxies::Capsule> end = {{{next - 3, 0, 0.1}, {next + 3, 0, 0.1}, 0.999}};
      FrameInput input;
      input.substeps = 10;
      input.colliders = {start, end, std::nullopt};
      input.friction = coefficients;
      ASSERT_FALSE(cloth.step(input, *query).has_value());
      x = next;
    }
    double mean = 0.0;
    for (int i = 0; i < garment.particle_count(); ++i)
      mean += (cloth.particles().positions[i].x() - garment.rest_positions[i].x()) / garment.particle_count();
    EXPECT_NEAR(mean, friction > 0.0 ? 0.2 : 0.0, 0.02) << friction;
  }
}

TEST(Xpbd, RunsAreRepeatable) {
  const Garment garment = sheet(12, true, {}, {0, 0, 0.5});
  std::uint64_t hashes[2] = {};
  for (std::uint64_t& hash : hashes) {
    const std::unique_ptr<Solver> owner = make_xpbd(garment, {});
    Solver& cloth = *owner;
    FrameInput input;
    input.substeps = 8;
    run(cloth, garment, input, 50);
    hash = state_hash(cloth.particles());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Xpbd, DivergenceIsCaughtInItsSubstep) {
  const Garment garment = sheet(5, true);
  const std::unique_ptr<Solver> owner = make_xpbd(garment, {});
  Solver& cloth = *owner;
  std::vector<Vec3> start, end;
  for (const Pin& pin : garment.pins) {
    start.push_back(garment.rest_positions[pin.particle]);
    end.push_back(start.back() + Vec3(pin.particle == 0 ? 100.0 : 0.0, 0, 0)); // torn apart
  }
  FrameInput input;
  input.pins_start = start;
  input.pins_end = end;
  const auto query = proxies::make_query(proxies::Backend::brute);
  const auto result = cloth.step(input, *query);
  const Divergence* divergence = divergence_of(result);
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->substep, 0);
  EXPECT_EQ(divergence->trouble, Trouble::long_edge);
  EXPECT_GT(divergence->stretch(), 10.0);
}

} // namespace
