// Cloth against the true body.
#include "cloth/detail/solver_parts.h"
#include "cloth/recovery.h"
#include "cloth/state/tolerances.h"
#include "src/study/bench/mesh_sheet.h"
#include "tests/support/solids.h"

#include <gtest/gtest.h>
#include <limits>

using namespace tutu;
using namespace tutu::cloth;

namespace {

Garment sheet(int n) {
  GarmentDescription description;
  description.file = "sheet";
  description.shape = GridShape{n, n, {-0.25, 1, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}};
  return build_garment(description);
}

/// Irregular triangles of about 10 cm, as large.
Garment irregular_sheet(double thickness = Fabric().thickness) {
  GarmentDescription description;
  description.file = "mesh";
  description.shape = app::mesh_sheet(5, {-0.25, 1, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}, 0.25);
  description.fabric.thickness = thickness;
  return build_garment(description);
}

/// A ball that swings under a falling sheet.
struct Ball {
  test::Surface surface = test::sphere_surface(0.15, 3);
  std::vector<Vec3f> start = surface.positions, end = surface.positions;

  void move_to(const Vec3& place) {
    start.swap(end);
    for (std::size_t v = 0; v < end.size(); ++v) end[v] = surface.positions[v] + place.cast<float>();
  }
  proxies::SweptColliders swept(std::optional<proxies::Plane> ground) const { return {{}, {}, ground, {}, start, end}; }
  std::unique_ptr<proxies::CollisionQuery> query() const {
    return proxies::make_mesh_query({surface.positions, surface.triangles});
  }
};

TEST(MeshBackend, EverySolverKeepsEveryParticleOutside) {
  const Garment garment = sheet(24);
  for (const SolverKind kind : {SolverKind::xpbd, SolverKind::mass_spring}) {
    Ball ball;
    const auto query = ball.query();
    const auto solver = make_solver(garment, {.solver = kind});
    const std::vector<double> friction = {0.5, 0.3};
    FrameInput input;
    input.friction = friction;
    input.substeps = kind == SolverKind::xpbd ? 8 : 24;
    ball.move_to({0, 0.8, 0});
    for (int frame = 0; frame < 60; ++frame) {
      ball.move_to({0.1 * std::sin(0.1 * frame), 0.8, 0});
      input.colliders = ball.swept(proxies::Plane{Vec3::UnitY(), 0.6});
      ASSERT_FALSE(solver->step(input, *query)) << name_of(kind);
      for (const Vec3& p : solver->particles().positions) {
        EXPECT_GT(query->contact(p, input.colliders.body_index()).distance, -1e-6) << name_of(kind) << ' ' << frame;
        EXPECT_GT(p.y(), 0.6 - 1e-6);
      }
    }
    EXPECT_GT(solver->contact_counts().contacts, 1000);
    EXPECT_LT(solver->contact_counts().queries, solver->contact_counts().candidates * input.substeps * 2 / 3);
  }
}

/// Of 28 points of each triangle the deepest, m.
double deepest(const Garment& garment, const Solver& solver, const proxies::CollisionQuery& query, int body) {
  const std::vector<Vec3>& x = solver.particles().positions;
  double deepest = 0.0;
  for (const auto& [a, b, c] : garment.triangles)
    for (int u = 0; u <= 6; ++u)
      for (int v = 0; u + v <= 6; ++v) {
        const Vec3 p = (x[a] * u + x[b] * v + x[c] * (6 - u - v)) / 6.0;
        deepest = std::max(deepest, -query.contact(p, body).distance);
      }
  return deepest;
}

TEST(MeshBackend, EdgesAndFacesKeepABallOutBetweenParticles) {
  for (const Garment& garment : {sheet(6), irregular_sheet()}) // cells of 10 cm on a ball of 15
    for (const SolverKind kind : {SolverKind::xpbd, SolverKind::mass_spring}) {
      SCOPED_TRACE(std::string(name_of(kind)) + (garment.rows > 0 ? ", grid" : ", mesh"));
      const auto run = [&](ContactFeatures features) {
        Ball ball;
        const auto query = ball.query();
        const auto solver = make_solver(garment, {.solver = kind, .features = features});
        FrameInput input;
        input.substeps = kind == SolverKind::xpbd ? 8 : 24;
        double worst = 0.0;
        ball.move_to({0, 0.84, 0});
        for (int frame = 0; frame < 30; ++frame) {
          ball.move_to({0.1 * std::sin(0.1 * frame), 0.84, 0});
          input.colliders = ball.swept(std::nullopt);
          EXPECT_FALSE(solver->step(input, *query));
          worst = std::max(worst, deepest(garment, *solver, *query, input.colliders.body_index()));
        }
        return worst;
      };
      EXPECT_GT(run(ContactFeatures::particles), 0.003);
      EXPECT_LT(run(ContactFeatures::triangles), 0.0005);
    }
}

/// A body that is nearly nothing, that goes through itself, or touches itself, or was turned over here and there; and
/// friction that lets nothing go, cloth without thickness, and with more than there is room for: only numbers.
TEST(MeshBackend, BodiesThatNoSceneShouldHaveGiveNumbers) {
  test::Surface flat = test::sphere_surface(0.15, 2), crossed = flat, touching = flat, turned = flat;
  for (Vec3f& p : flat.positions) p.y() *= 1e-4f;
  test::append(crossed, test::sphere_surface(0.1, 2, {0.1f, 0.02f, 0}));
  test::append(touching, test::sphere_surface(0.15, 2, {0.3f, 0, 0}));
  std::swap(turned.triangles[40][1], turned.triangles[40][2]);
  const std::array<std::uint32_t, 3> sliver = {turned.triangles[7][0], turned.triangles[7][0], turned.triangles[7][1]};
  turned.triangles.push_back(sliver);
  for (const test::Surface& surface : {flat, crossed, touching, turned})
    for (const double thickness : {0.0, 0.004, 0.5})
      for (const SolverKind kind : {SolverKind::xpbd, SolverKind::mass_spring}) {
        const Garment garment = irregular_sheet(thickness);
        Ball body;
        body.surface = surface;
        body.start = body.end = surface.positions;
        const auto query = body.query();
        const auto solver = make_solver(garment, {.solver = kind, .features = ContactFeatures::triangles});
        const std::vector<double> friction = {1e6, 1e6};
        FrameInput input;
        input.friction = friction;
        input.substeps = kind == SolverKind::xpbd ? 6 : 24;
        body.move_to({0, 0.84, 0});
        for (int frame = 0; frame < 12; ++frame) {
          body.move_to({0, 0.84 + 0.2 * std::sin(0.4 * frame), 0});
          input.colliders = body.swept(std::nullopt);
          if (solver->step(input, *query)) break; // told, not shown
          for (const Vec3& p : solver->particles().positions) ASSERT_TRUE(p.allFinite());
          for (const Vec3& v : solver->particles().velocities) ASSERT_TRUE(v.allFinite());
        }
      }
  for (Vec3f& p : flat.positions) p.y() = 0.0f;
  EXPECT_THROW(proxies::BodyMesh(flat.positions, flat.triangles), std::invalid_argument) << "no thickness at all";
}

TEST(MeshBackend, ClothThatBeginsInsideIsWorkedOutNotThrown) {
  const Garment garment = sheet(12);
  Ball ball;
  const auto query = ball.query();
  const auto solver = make_solver(garment, {});
  ball.move_to({0, 0.95, 0}); // the sheet lies 10 cm deep in it
  ball.move_to({0, 0.95, 0});
  FrameInput input;
  input.gravity = Vec3::Zero();
  input.substeps = 8;
  input.colliders = ball.swept(std::nullopt);
  double fastest = 0.0, deepest = 0.0;
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_FALSE(solver->step(input, *query));
    for (const Vec3& v : solver->particles().velocities) fastest = std::max(fastest, v.norm());
    deepest = 0.0;
    for (const Vec3& p : solver->particles().positions)
      deepest = std::max(deepest, -query->contact(p, input.colliders.body_index()).distance);
    if (frame == 0) {
      EXPECT_GT(deepest, 0.05) << "not at once";
    }
  }
  EXPECT_LT(deepest, 1e-6);
  EXPECT_LT(fastest, 3.0 * k_push_out_speed);
}

TEST(MeshBackend, FrictionCarriesClothAlong) {
  const Garment garment = sheet(16);
  std::array<double, 2> carried = {};
  for (const double mu : {0.0, 1.0}) {
    test::Surface plate = test::box_surface({1.0f, 0.1f, 1.0f});
    const auto query = proxies::make_mesh_query({plate.positions, plate.triangles});
    const auto solver = make_solver(garment, {});
    const std::vector<double> friction = {0.0, mu};
    std::vector<Vec3f> start, end;
    const auto at = [&](double x) {
      std::vector<Vec3f> moved = plate.positions;
      for (Vec3f& p : moved) p += Vec3f(static_cast<float>(x), 0.9f - 0.002f, 0.0f);
      return moved;
    };
    FrameInput input;
    input.friction = friction;
    input.substeps = 8;
    for (int frame = 0; frame < 60; ++frame) {
      const auto x = [](int f) { return 0.5 * 0.3 * f * f / 3600.0; }; // at 0.3 m/s2
      start = at(x(frame));
      end = at(x(frame + 1));
      input.colliders = {{}, {}, std::nullopt, {}, start, end};
      ASSERT_FALSE(solver->step(input, *query));
    }
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < garment.rest_positions.size(); ++i)
      mean += (solver->particles().positions[i] - garment.rest_positions[i]) /
              static_cast<double>(garment.rest_positions.size());
    carried[mu > 0.0] = mean.x();
  }
  EXPECT_NEAR(carried[0], 0.0, 0.005);
  EXPECT_NEAR(carried[1], 0.15, 0.01);
}

TEST(MeshBackend, ABodyThatIsNowhereIsToldNotAsked) {
  const Garment garment = sheet(8);
  Ball ball;
  const auto query = ball.query();
  GuardedSolver solver(make_solver(garment, {}), garment);
  ball.end[5].y() = std::numeric_limits<float>::infinity();
  FrameInput input;
  input.colliders = ball.swept(std::nullopt);
  EXPECT_TRUE(solver.step(input, *query));
}

} // namespace
