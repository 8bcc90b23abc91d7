// A garment's memory is known before it is taken.
#include "cloth/garment/garment_memory.h"
#include "cloth/recovery.h"
#include "cloth/solver.h"
#include "rig/error.h"
#include "src/study/bench/mesh_sheet.h"
#include "tests/support/peak_memory.h"

#include <gmock/gmock.h>

// GCC 12 takes the variant in a description for uninitialised where it is moved at -O1: it is not.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

using namespace tutu;
using namespace tutu::cloth;
using test::Variable;
using ::testing::HasSubstr;

namespace {

GarmentDescription of(std::variant<GridShape, TubeShape, DiscShape, MeshShape> shape) {
  GarmentDescription description;
  description.file = "garment.json";
  description.shape = std::move(shape);
  return description;
}

GridShape grid(int n) { return {n, n, {-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}}; }
TubeShape tube(int n) {
  TubeShape shape;
  shape.rows = shape.columns = n;
  shape.rings = {{1.0, 0.2, 0.15, 0, 0}, {0.5, 0.5, 0.4, 0, 0}};
  return shape;
}
DiscShape disc(int rings, double hole) { return {{0, 1, 0}, 0.5, 0.5, rings, hole}; }

TEST(GarmentMemory, ParticlesAreCountedBeforeTheyAreMade) {
  TubeShape slit = tube(9);
  slit.seam = 0.5;
  for (const GarmentDescription& description :
       {of(grid(7)), of(tube(9)), of(slit), of(app::mesh_sheet(6, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}))})
    EXPECT_EQ(particles_of(description), build_garment(description).rest_positions.size());
  for (const int rings : {1, 2, 7, 40})
    for (const double hole : {0.0, 0.1, 0.3, 0.9}) {
      const double made = build_garment(of(disc(rings, hole))).particle_count();
      EXPECT_NEAR(static_cast<double>(particles_of(of(disc(rings, hole)))), made, 4.0 + 0.02 * made)
          << rings << ' ' << hole;
    }
}

InputError refusal_of(const GarmentDescription& description) {
  try {
    build_garment(description);
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "built";
  return {"", "", "", ""};
}

TEST(GarmentMemory, WhatIsTooLargeIsRefusedWithItsPlaceAndSize) {
  const Variable none("TUTU_MEMORY_GIB", nullptr);
  const double before = test::memory_now("VmRSS");
  const InputError error = refusal_of(of(grid(4096)));
  EXPECT_EQ(error.file(), "garment.json");
  EXPECT_EQ(error.place(), "/shape/grid");
  EXPECT_THAT(error.found(), HasSubstr("a garment of 16,777,216 particles, about "));
  EXPECT_THAT(error.expected(), HasSubstr("at most 2 GiB; TUTU_MEMORY_GIB="));
  EXPECT_EQ(refusal_of(of(tube(4096))).place(), "/shape/tube");
  EXPECT_EQ(refusal_of(of(disc(1024, 0.0))).place(), "/shape/disc");
  EXPECT_LT(test::memory_now("VmRSS") - before, 16e6) << "nothing was allocated for it";

  const Variable small("TUTU_MEMORY_GIB", "0.001");
  const MeshShape mesh = app::mesh_sheet(60, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  EXPECT_EQ(refusal_of(of(mesh)).place(), "/shape/mesh");
  EXPECT_THAT(refusal_of(of(grid(60))).found(), HasSubstr("3,600 particles"));
  EXPECT_THAT(refusal_of(of(grid(60))).expected(), HasSubstr("at most 0.001 GiB; TUTU_MEMORY_GIB=1 raises the limit"));
  EXPECT_EQ(build_garment(of(grid(10))).particle_count(), 100);
}

/// Built, and simulated for two frames among some limbs.
void simulate(const GarmentDescription& description, const SolverOptions& options, int colliders) {
  const Garment garment = build_garment(description);
  GuardedSolver solver(make_solver(garment, options), garment);
  const auto query = proxies::make_query(proxies::Backend::hybrid);
  std::vector<proxies::Capsule> limbs;
  for (int k = 0; k < colliders; ++k) {
    const double x = -0.5 + (k + 0.5) / colliders;
    limbs.push_back({{x, 0.9, -0.5}, {x, 0.9, 0.5}, 0.04});
  }
  FrameInput input;
  input.colliders = {limbs, limbs, std::nullopt};
  input.substeps = 2;
  for (int f = 0; f < 2; ++f) (void)solver.step(input, *query); // whether it holds or helps itself does not matter
}

TEST(GarmentMemory, TheEstimateIsNotBelowTheTruth_slow) {
  struct Case {
    const char* name;
    GarmentDescription description;
    SolverOptions options;
  };
  const SolverOptions precise{.double_precision = true}, springs{.solver = SolverKind::mass_spring};
  const SolverOptions apart{.self_collision = true, .double_precision = true};
  const MeshShape mesh = app::mesh_sheet(400, {-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}, 0.2);
  for (const int colliders : {1, 36})
    for (const Case& what : {Case{"grid", of(grid(400)), {}},
                             {"grid, double", of(grid(400)), precise},
                             {"grid, self", of(grid(400)), apart},
                             {"grid, springs", of(grid(400)), springs},
                             {"tube, double", of(tube(400)), precise},
                             {"disc", of(disc(230, 0.0)), {}},
                             {"mesh", of(mesh), {}},
                             {"mesh, double", of(mesh), precise},
                             {"mesh, springs", of(mesh), springs}}) {
      const double estimate = memory_of(what.description, static_cast<std::size_t>(colliders));
      const double taken = test::peak_memory_of([&] { simulate(what.description, what.options, colliders); });
      const auto particles = static_cast<double>(particles_of(what.description));
      std::printf("%-14s %2d colliders: %5.0f bytes a particle, estimated %5.0f\n", what.name, colliders,
                  taken / particles, estimate / particles);
      EXPECT_LE(taken, 1.02 * estimate) << what.name << ", " << colliders << " colliders";
      EXPECT_GE(taken, estimate / 4.0) << what.name << ", " << colliders << " colliders";
    }
}

} // namespace
