// The force of the air against its formula: on a plate, on falling and hanging sheets, and where it is far too strong
// for the step.
#include "cloth/air/air.h"
#include "cloth/air/wind.h"
#include "cloth/solver.h"
#include "src/study/bench/mesh_sheet.h"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <random>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr double k_gravity = 9.81;

/// What cloth may be, and what moves it.
struct Kind {
  const char* name;
  SolverOptions options;
  bool is_mesh;
};
const Kind k_kinds[] = {{"xpbd, woven", {}, false},
                        {"xpbd, woven, double", {.double_precision = true}, false},
                        {"xpbd, mesh", {}, true},
                        {"mass_spring", {.solver = SolverKind::mass_spring}, false}};

Fabric fabric_of(double density) {
  Fabric fabric;
  fabric.density = density;
  fabric.drag = 0.0;
  fabric.air = Air{};
  return fabric;
}

Garment sheet(const Kind& kind, const Fabric& fabric, const Vec3& across, const Vec3& down, bool held = false) {
  GarmentDescription description;
  description.file = "sheet";
  description.fabric = fabric;
  const Vec3 corner(-0.2, 1, 0);
  if (kind.is_mesh) description.shape = app::mesh_sheet(9, corner, across, down, 0.1);
  else description.shape = GridShape{11, 10, corner, across, down};
  if (held) {
    description.attachments.emplace_back();
    description.attachments.back().above = 1.0 - 1e-6;
  }
  return build_garment(description);
}

Vec3 mean_velocity(const Garment& garment, std::span<const Vec3> velocities) {
  Vec3 momentum = Vec3::Zero();
  double mass = 0.0;
  for (int i = 0; i < garment.particle_count(); ++i) {
    momentum += garment.masses[i] * velocities[i];
    mass += garment.masses[i];
  }
  return momentum / mass;
}

void run(Solver& solver, const Garment& garment, FrameInput input, double seconds) {
  const auto query = proxies::make_query(proxies::Backend::brute);
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  input.pins_start = input.pins_end = pins;
  for (int f = 0; f < static_cast<int>(std::lround(60.0 * seconds)); ++f)
    if (const auto end = solver.step(input, *query)) FAIL() << f << ": " << what_was_found(*divergence_of(end));
}

/// A plate at every angle to the wind, for so short a step that nothing changes: the force is the formula's.
TEST(Air, AStiffPlateTakesTheForceOfTheFormula) {
  Fabric fabric = fabric_of(0.2);
  fabric.air = Air{1.1, 1.4, 0.3};
  const Garment garment = sheet(k_kinds[2], fabric, {0.4, 0, 0}, {0, 0, 0.3});
  const std::vector<std::uint8_t> free(garment.rest_positions.size(), 0);
  const Vec3 wind(1.5, 0.2, -0.4);
  const double area = 0.4 * 0.3, h = 1e-7;
  for (int degrees = 0; degrees <= 180; degrees += 15) {
    const double angle = degrees * std::numbers::pi / 180.0, speed = 3.0; // from edge-on
    const Vec3 u = speed * Vec3(std::cos(angle), std::sin(angle), 0);
    std::vector<Vec3> velocities(free.size(), u + wind);
    apply_air(garment, free, wind, h, garment.rest_positions, velocities);
    const Vec3 force = fabric.density * area / h * (mean_velocity(garment, velocities) - u - wind);
    const double sine = std::sin(angle), cosine = std::abs(std::cos(angle)), q = 0.5 * k_air_density * speed * speed;
    const double normal = q * area * (1.1 * sine * sine + 1.4 * sine * cosine);
    const double tangent = q * area * 0.3 * std::cos(angle) * cosine;
    EXPECT_NEAR(force.x(), -tangent, 1e-5 * q * area) << degrees;
    EXPECT_NEAR(force.y(), -normal, 1e-5 * q * area) << degrees;
    EXPECT_NEAR(force.z(), 0.0, 1e-5 * q * area) << degrees;
    EXPECT_LE(force.dot(u), 0.0);
  }
}

TEST(Air, TerminalSpeedsAreThoseOfTheFormula_slow) {
  std::printf("%-20s %10s %28s %28s\n", "", "kg/m2", "face-on, m/s", "edge-on, m/s");
  for (const Kind& kind : k_kinds)
    for (const double density : {0.02, 0.06, 0.12, 0.4}) {
      const Fabric fabric = fabric_of(density);
      const auto speed = [&](double coefficient) {
        return std::sqrt(2.0 * density * k_gravity / (k_air_density * coefficient));
      };
      const auto fallen = [&](const Vec3& down, double terminal) {
        const Garment garment = sheet(kind, fabric, {0.4, 0, 0}, down);
        const auto solver = make_solver(garment, kind.options);
        FrameInput input;
        input.substeps = kind.options.solver == SolverKind::mass_spring ? 48 : 12;
        run(*solver, garment, input, 4.0 * terminal / k_gravity); // tanh 4 = 0.9993
        return mean_velocity(garment, solver->particles().velocities);
      };
      const double face = speed(fabric.air->pressure), edge = speed(fabric.air->friction);
      const Vec3 face_on = fallen({0, 0, 0.4}, face), edge_on = fallen({0, -0.4, 0}, edge);
      std::printf("%-20s %10g %12.3f of %.3f %+.1f %% %12.3f of %.3f %+.1f %%\n", kind.name, density, -face_on.y(),
                  face, 100.0 * (-face_on.y() / face - 1.0), -edge_on.y(), edge, 100.0 * (-edge_on.y() / edge - 1.0));
      EXPECT_NEAR(-face_on.y(), face, 0.02 * face) << kind.name << " of " << density << " kg/m2";
      EXPECT_NEAR(-edge_on.y(), edge, 0.02 * edge) << kind.name << " of " << density << " kg/m2";
      EXPECT_LT(std::hypot(face_on.x(), face_on.z()), 0.02 * face);
      EXPECT_LT(std::hypot(edge_on.x(), edge_on.z()), 0.02 * edge);
    }
}

/// Held at its upper edge in a level wind, a sheet comes to rest flat: across it the air carries its weight.
TEST(Air, ASheetHangsInTheWindWhereWeightAndNormalForceAgree_slow) {
  for (const Kind& kind : k_kinds)
    for (const double wind : {0.5, 1.0, 1.5}) {
      const Fabric fabric = fabric_of(0.2);
      const Garment garment = sheet(kind, fabric, {0.4, 0, 0}, {0, -0.4, 0}, true);
      const auto solver = make_solver(garment, kind.options);
      FrameInput input;
      input.substeps = kind.options.solver == SolverKind::mass_spring ? 48 : 12;
      input.wind_start = input.wind_end = Vec3(0, 0, wind);
      input.extra_drag = 1.0; // against the ground, not the wind: it settles
      run(*solver, garment, input, 12.0);
      double fastest = 0.0;
      for (const Vec3& v : solver->particles().velocities) fastest = std::max(fastest, v.norm());
      EXPECT_LT(fastest, 0.02) << kind.name << " at " << wind << " m/s";
      double low = 0.0, high = 0.5 * std::numbers::pi; // from the vertical
      for (int k = 0; k < 60; ++k) {
        const double angle = 0.5 * (low + high), c = std::cos(angle), s = std::sin(angle);
        const double across =
            0.5 * k_air_density * wind * wind * (fabric.air->pressure * c * c + fabric.air->lift * c * s);
        (across > fabric.density * k_gravity * s ? low : high) = angle;
      }
      Vec3 hem = Vec3::Zero();
      for (int i = 0; i < garment.particle_count(); ++i)
        if (garment.rest_positions[i].y() < 0.6 + 1e-6) hem += solver->particles().positions[i] - Vec3(0, 1, 0);
      const double found = std::atan2(hem.z(), -hem.y());
      EXPECT_NEAR(found, low, 0.015) << kind.name << " at " << wind << " m/s: " << low << " rad";
    }
}

/// Light cloth in a storm, in steps as long as they may be: nothing overshoots, whatever the shape.
TEST(Air, NeverTurnsARelativeVelocityRound) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> number;
  for (const Kind& kind : {k_kinds[0], k_kinds[2]})
    for (const double h : {1e-3, 1.0 / 60.0, 1.0}) {
      const Garment flat = sheet(kind, fabric_of(0.02), {0.4, 0, 0}, {0, 0, 0.4});
      const std::vector<std::uint8_t> free(flat.rest_positions.size(), 0);
      const Vec3 wind = 100.0 * Vec3(number(random), number(random), number(random)).normalized();
      std::vector<Vec3> velocities(free.size(), Vec3::Zero());
      for (int step = 0; step < 5; ++step) {
        const std::vector<Vec3> before = velocities;
        apply_air(flat, free, wind, h, flat.rest_positions, velocities);
        for (std::size_t i = 0; i < free.size(); ++i) {
          const Vec3 was = before[i] - wind, is = velocities[i] - wind;
          ASSERT_GE(is.y() * was.y(), 0.0) << i;
          ASSERT_LE(std::abs(is.y()), std::abs(was.y())) << i;
          ASSERT_LE(is.norm(), was.norm()) << i;
        }
      }
      // Crumpled and in disorder, the same of lengths.
      std::vector<Vec3> crumpled = flat.rest_positions;
      for (std::size_t i = 0; i < free.size(); ++i) {
        crumpled[i] += 0.05 * Vec3(number(random), number(random), number(random));
        velocities[i] = 50.0 * Vec3(number(random), number(random), number(random));
      }
      const std::vector<Vec3> before = velocities;
      apply_air(flat, free, wind, h, crumpled, velocities);
      for (std::size_t i = 0; i < free.size(); ++i)
        ASSERT_LE((velocities[i] - wind).norm(), (before[i] - wind).norm() * (1.0 + 1e-12)) << i;
    }
}

TEST(Air, LightClothInAStormWithOneSubstepGoesWithTheWind) {
  for (const Kind& kind : k_kinds) {
    Fabric fabric = fabric_of(0.02);
    if (kind.options.solver == SolverKind::mass_spring) { // whose springs stand no such step
      fabric.stretch = 0.05;
      fabric.shear = 0.01;
      fabric.bend_springs = 0.0;
    }
    const Garment garment = sheet(kind, fabric, {0.4, 0, 0}, {0, 0, 0.4});
    const auto solver = make_solver(garment, kind.options);
    FrameInput input;
    input.substeps = 1;
    input.gravity.setZero();
    input.wind_start = input.wind_end = Vec3(0, k_fastest_wind, 0);
    for (int frame = 0; frame < 60; ++frame) {
      run(*solver, garment, input, 1.0 / 60.0);
      const double mean = mean_velocity(garment, solver->particles().velocities).y();
      EXPECT_GT(mean, (frame < 3 ? 0.8 : 0.95) * k_fastest_wind) << kind.name << " in frame " << frame;
      EXPECT_LT(mean, k_fastest_wind + 1e-3) << kind.name;
    }
  }
}

TEST(Air, WindDoesNothingToClothWithoutAir) {
  for (const Kind& kind : k_kinds) {
    Fabric fabric = fabric_of(0.1);
    fabric.air.reset();
    const Garment garment = sheet(kind, fabric, {0.4, 0, 0}, {0, 0, 0.4}, true);
    std::uint64_t hashes[2];
    for (const bool blows : {false, true}) {
      const auto solver = make_solver(garment, kind.options);
      FrameInput input;
      input.substeps = 30;
      if (blows) input.wind_start = input.wind_end = Vec3(5, 5, 5);
      run(*solver, garment, input, 0.2);
      hashes[blows] = state_hash(solver->particles());
    }
    EXPECT_EQ(hashes[0], hashes[1]) << kind.name;
  }
}

TEST(Air, HeldParticlesStayAndCarryTheWind) {
  const Garment garment = sheet(k_kinds[0], fabric_of(0.1), {0.4, 0, 0}, {0, -0.4, 0}, true);
  const auto pinned = pinned_flags(garment);
  std::vector<Vec3> velocities(pinned.size(), Vec3(0.1, 0.2, 0.3));
  apply_air(garment, pinned, {0, 0, 3}, 0.01, garment.rest_positions, velocities);
  for (std::size_t i = 0; i < pinned.size(); ++i)
    if (pinned[i]) EXPECT_EQ(velocities[i], Vec3(0.1, 0.2, 0.3));
    else EXPECT_GT(velocities[i].z(), 0.3);
}

} // namespace
