// Cloth between two colliders that leave it no room: the rule for a particle, and sheets between closing walls.
#include "cloth/contact/between_colliders.h"
#include "cloth/solver.h"
#include "cloth/state/tolerances.h"
#include "proxies/distance/signed_distance.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>

namespace tutu::cloth {
namespace {

Garment sheet(int n, double size = 0.4) {
  GarmentDescription description;
  description.name = "sheet";
  description.shape = GridShape{n, n, {-0.5 * size, 1.0, 0.0}, {size, 0, 0}, {0, -size, 0}};
  description.attachments = {{.joint = "stage", .last_row = 0}};
  return build_garment(description);
}

/// The same as a mesh, whose threads are its edges.
Garment mesh_sheet(int n) {
  Garment mesh = sheet(n);
  mesh.rows = mesh.columns = 0;
  return mesh;
}

/// A flat surface at `distance` from a particle that is to keep `need`, m, and how far it has moved.
NearCollider wall(int collider, const Vec3& normal, double distance, double need, const Vec3& surface = Vec3::Zero()) {
  NearCollider near;
  near.collider = collider;
  near.contact.normal = normal.normalized();
  near.contact.distance = distance;
  near.need = need;
  near.surface = surface;
  near.moved = surface.norm();
  return near;
}

TEST(BetweenColliders, OnlyOpposedNormalsPinch) {
  const std::vector<NearCollider> beside = {wall(0, {1, 0, 0}, 0.0, 0.01), wall(1, {0, 1, 0}, 0.0, 0.01)};
  EXPECT_FALSE(opposed(beside));
  EXPECT_FALSE(opposed({}));
  std::vector<NearCollider> three = beside;
  three.push_back(wall(2, {-1, -0.2, 0}, 0.0, 0.01));
  const auto pair = opposed(three);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->first, 0u) << "the most opposed of three";
  EXPECT_EQ(pair->second, 2u);
}

TEST(BetweenColliders, AParticleLacksAsMuchOfOneAsOfTheOther) {
  const Garment garment = sheet(5);
  const BetweenColliders between(garment);
  const std::vector<Vec3>& x = garment.rest_positions;
  const int i = 12;
  const std::vector<NearCollider> near = {wall(0, {1, 0.2, 0}, -0.006, 0.002), wall(1, {-1, 0.1, 0}, 0.001, 0.002)};
  const auto settled = between.settle({i, x[i], 1.0}, near, x);
  ASSERT_TRUE(settled);
  const double first = 0.008 - settled->way.dot(near[0].contact.normal);
  const double second = 0.001 - settled->way.dot(near[1].contact.normal);
  EXPECT_NEAR(first, second, 1e-15);
  EXPECT_EQ(settled->by, 0) << "what it lacks more of pushes";
}

TEST(BetweenColliders, ItMovesOnWithBothSurfacesAndIsNotThrown) {
  const Garment garment = sheet(5);
  const BetweenColliders between(garment);
  std::vector<Vec3> x = garment.rest_positions;
  const int i = 12;
  const Vec3 start = x[i], left(0.003, 0, 0), right(-0.001, 0, 0);
  x[i] += Vec3(0.02, 0.004, 0); // what the constraints and its speed did
  const std::vector<NearCollider> near = {wall(0, {1, 0, 0}, -0.004, 0.002, left),
                                          wall(1, {-1, 0, 0}, -0.03, 0.002, right)};
  const auto settled = between.settle({i, start, 1.0}, near, x);
  ASSERT_TRUE(settled);
  const Vec3 way = x[i] + settled->way - (start + settled->start); // of which its velocity is made
  EXPECT_NEAR(way.x(), 0.001, 1e-15) << "as fast as both surfaces on the mean";
  EXPECT_NEAR(way.y(), 0.004, 1e-15) << "and along them as before, where nothing rubs";
}

TEST(BetweenColliders, NoPushMakesAThreadLongerThanItMayBe) {
  const Garment garment = sheet(6);
  const BetweenColliders between(garment);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> off(-0.03, 0.03);
  int cut = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<Vec3> x = garment.rest_positions;
    for (Vec3& p : x) p += Vec3(off(random), off(random), off(random));
    const int i = static_cast<int>(random() % x.size());
    const Vec3 way = 2.0 * Vec3(off(random), off(random), off(random)), fitted = between.fitted(i, way, x);
    EXPECT_NEAR(fitted.cross(way).norm(), 0.0, 1e-12) << "the same direction";
    cut += fitted.norm() < way.norm();
    for (int k = 0; k < garment.structural_count; ++k) {
      const Spring& thread = garment.springs[k];
      if (thread.i != i && thread.j != i) continue;
      const Vec3 r = x[i] - x[thread.i == i ? thread.j : thread.i];
      EXPECT_LE((r + fitted).norm(), std::max(k_pinched_thread * thread.rest_length, r.norm()) + 1e-12);
    }
  }
  EXPECT_GT(cut, 600);
  EXPECT_LT(cut, 1900);
}

TEST(BetweenColliders, LessIsAskedOfWhatHangsOnAHeldParticleWithin) {
  const Garment garment = sheet(5); // cells of 0.1 m
  const BetweenColliders between(garment);
  EXPECT_DOUBLE_EQ(between.need(12, 0.002, 0.0), 0.002) << "0.2 m from the held row: all of it";
  EXPECT_NEAR(between.need(7, 0.002, -0.1), -0.1 + k_pinched_reach * 0.1, 1e-12) << "0.1 m from one that is as deep";
  GarmentDescription loose;
  loose.shape = GridShape{4, 4, {0, 1, 0}, {0.3, 0, 0}, {0, -0.3, 0}};
  EXPECT_DOUBLE_EQ(BetweenColliders(build_garment(loose)).need(5, 0.002, -1.0), 0.002) << "nothing holds it";
}

/// A hanging sheet between two limbs that close on it until they overlap by `overlap`. Returns how far
/// the particles between them are off the middle, m, and the longest thread's strain.
struct Pressed {
  double off_middle = 0.0, longer = 0.0;
  int between = 0;
};
struct Asked {
  bool is_mesh = false;
  proxies::Backend backend = proxies::Backend::hybrid;
  SolverKind solver = SolverKind::xpbd;
};
Pressed press(int n, int substeps, double overlap, const Asked& asked = {}) {
  const Garment garment = asked.is_mesh ? mesh_sheet(n) : sheet(n);
  SolverOptions options;
  options.solver = asked.solver;
  const auto solver = make_solver(garment, options);
  const auto query = proxies::make_query(asked.backend);
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  FrameInput input;
  input.pins_start = input.pins_end = pins;
  input.substeps = substeps;
  const auto walls = [&](double gap) {
    const double radius = 0.1, y = 0.8;
    return std::vector<proxies::Capsule>{{{-0.5, y, -radius - 0.5 * gap}, {0.5, y, -radius - 0.5 * gap}, radius},
                                         {{-0.5, y, radius + 0.5 * gap}, {0.5, y, radius + 0.5 * gap}, radius}};
  };
  constexpr int k_frames = 60;
  std::vector<proxies::Capsule> from = walls(0.06), to;
  for (int frame = 1; frame <= 2 * k_frames; ++frame) {
    const double t = std::min(1.0, static_cast<double>(frame) / k_frames);
    to = walls(0.06 - t * (0.06 + overlap));
    input.colliders = {from, to, std::nullopt};
    if (solver->step(input, *query)) return {1.0, 1.0, 0};
    from = to;
  }
  Pressed result;
  const std::vector<Vec3>& x = solver->particles().positions;
  for (const Vec3& p : x) {
    const double first = proxies::signed_distance(p, to[0]).distance,
                 second = proxies::signed_distance(p, to[1]).distance;
    if (first > 0.0 || second > 0.0) continue;
    ++result.between;
    result.off_middle = std::max(result.off_middle, 0.5 * std::abs(first - second));
  }
  for (int k = 0; k < garment.structural_count; ++k) {
    const Spring& s = garment.springs[k];
    result.longer = std::max(result.longer, (x[s.i] - x[s.j]).norm() / s.rest_length - 1.0);
  }
  return result;
}

// Particles that are asked for themselves, in plain double: meshes, the other backends, mass_spring.
TEST(BetweenColliders, ASheetOfAnyKindLiesInTheMiddle_slow) {
  using proxies::Backend;
  for (const Asked& asked : {Asked{true},
                             {true, Backend::fcl},
                             {false, Backend::fcl},
                             {false, Backend::brute},
                             {false, Backend::hybrid, SolverKind::mass_spring},
                             {true, Backend::hybrid, SolverKind::mass_spring}})
    for (const int n : {15, 30})
      for (const int substeps : {12, 24, 48}) {
        if (asked.solver == SolverKind::mass_spring && substeps != 48) continue;
        const Pressed pressed = press(n, asked.solver == SolverKind::mass_spring ? 400 : substeps, 0.03, asked);
        SCOPED_TRACE(fmt::format("{}, backend {}, solver {}, {} a side, {} substeps", asked.is_mesh ? "mesh" : "grid",
                                 static_cast<int>(asked.backend), static_cast<int>(asked.solver), n, substeps));
        EXPECT_GT(pressed.between, 0);
        EXPECT_LE(pressed.off_middle, 1e-3);
        EXPECT_LE(pressed.longer, 0.2);
      }
}

TEST(BetweenColliders, ASheetBetweenClosingLimbsLiesInTheMiddle) {
  for (const int n : {15, 30, 60})
    for (const int substeps : {6, 12, 24}) {
      const Pressed pressed = press(n, substeps, 0.03);
      SCOPED_TRACE(std::to_string(n) + " a side, " + std::to_string(substeps) + " substeps");
      EXPECT_GT(pressed.between, 0);
      EXPECT_LE(pressed.off_middle, 1e-3);
      EXPECT_LE(pressed.longer, 0.2);
    }
}

} // namespace
} // namespace tutu::cloth
