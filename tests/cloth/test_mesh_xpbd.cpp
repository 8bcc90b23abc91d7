#include "cloth/detail/colouring.h"
#include "cloth/garment/dihedral.h"
#include "cloth/garment/springs.h"
#include "cloth/mesh_xpbd.h"
#include "cloth/metrics.h"
#include "src/study/bench/mesh_sheet.h"

#include <gtest/gtest.h>
#include <numbers>
#include <set>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr double k_size = 0.5; // m a side

/// `above`: particles from this height on are held.
Garment garment_of(MeshShape shape, const Fabric& fabric, std::optional<double> above = {}) {
  GarmentDescription description;
  description.file = "sheet";
  description.shape = std::move(shape);
  description.fabric = fabric;
  if (above) {
    description.attachments.emplace_back();
    description.attachments.back().above = above;
  }
  return build_garment(description);
}

Garment upright(int cells, const Fabric& fabric, bool held) {
  return garment_of(app::mesh_sheet(cells, {-0.25, 1, 0}, {k_size, 0, 0}, {0, -k_size, 0}, 0.1), fabric,
                    held ? std::optional(0.9999) : std::nullopt);
}

/// Runs frames with the pins where they were at rest.
void run(Solver& solver, const Garment& garment, const FrameInput& frame, int frames) {
  FrameInput input = frame;
  static const auto query = proxies::make_query(proxies::Backend::brute);
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  input.pins_start = input.pins_end = pins;
  for (int f = 0; f < frames; ++f) ASSERT_FALSE(solver.step(input, *query).has_value()) << f;
}

double energy_of(const Garment& garment, const Particles& particles) {
  double energy = elastic_energy(garment, particles.positions);
  const auto& x = particles.positions;
  for (const Bend& bend : build_bends(garment)) {
    const double turn = dihedral<double>(x[bend.a], x[bend.b], x[bend.c], x[bend.d]).angle() - bend.rest_angle;
    energy += 0.5 * bend.stiffness * turn * turn;
  }
  for (int i = 0; i < garment.particle_count(); ++i)
    energy += 0.5 * garment.masses[i] * particles.velocities[i].squaredNorm();
  return energy;
}

TEST(Colouring, NoTwoOfAColourShareAParticle) {
  std::mt19937 random(2);
  for (const int arity : {2, 4}) {
    std::vector<int> elements;
    for (int e = 0; e < 500; ++e) {
      std::set<int> particles;
      while (static_cast<int>(particles.size()) < arity) particles.insert(static_cast<int>(random() % 200));
      elements.insert(elements.end(), particles.begin(), particles.end());
    }
    const Colouring colouring = colour(elements, arity, 200);
    EXPECT_EQ(std::set<int>(colouring.order.begin(), colouring.order.end()).size(), 500u);
    ASSERT_EQ(colouring.begin.back(), 500);
    for (std::size_t c = 0; c + 1 < colouring.begin.size(); ++c) {
      std::set<int> seen;
      for (int k = colouring.begin[c]; k < colouring.begin[c + 1]; ++k)
        for (int p = 0; p < arity; ++p) EXPECT_TRUE(seen.insert(elements[colouring.order[k] * arity + p]).second);
    }
    EXPECT_LT(colouring.begin.size(), 60u);
  }
}

template <class Solver> class MeshXpbdTest : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(MeshXpbdTest, Precisions);

TYPED_TEST(MeshXpbdTest, FreeFallIsThatOfTheScheme) {
  Fabric fabric;
  fabric.drag = 0.0;
  const Garment garment = upright(6, fabric, false);
  MeshXpbd<TypeParam> cloth(garment);
  FrameInput input;
  input.substeps = 7;
  run(cloth, garment, input, 30);
  const double h = input.seconds / 7, n = 30 * 7;
  const Vec3 fall = input.gravity * (h * h * n * (n + 1) / 2);
  const double tolerance = std::is_same_v<TypeParam, float> ? 1e-5 : 1e-9; // of rest lengths' rounding
  for (int i = 0; i < garment.particle_count(); ++i)
    EXPECT_LT((cloth.particles().positions[i] - garment.rest_positions[i] - fall).norm(), tolerance);
}

TYPED_TEST(MeshXpbdTest, ConstraintsKeepMomentumAndNeverAddEnergy) {
  for (const double stretch : {10.0, 500.0})
    for (const double bend : {0.0, 1e-5, 1e-3, 1.0}) {
      Fabric fabric;
      fabric.drag = 0.0;
      fabric.stretch = stretch;
      fabric.bend = bend;
      const Garment garment = upright(10, fabric, false);
      std::mt19937_64 random(3);
      std::uniform_real_distribution<double> shift(-0.005, 0.005);
      std::vector<Vec3> shaken = garment.rest_positions;
      for (Vec3& p : shaken) p += Vec3(shift(random), shift(random), shift(random));
      MeshXpbd<TypeParam> cloth(garment);
      cloth.reset(shaken);
      FrameInput input;
      input.substeps = 10;
      input.gravity.setZero();
      // Springs that a substep cannot follow hold a little energy back and give it later: never more than there was.
      constexpr int k_windows = 6, k_frames = 20;
      double most = energy_of(garment, cloth.particles());
      for (int window = 0; window < k_windows; ++window) {
        double most_now = 0.0;
        for (int f = 0; f < k_frames; ++f) {
          run(cloth, garment, input, 1);
          most_now = std::max(most_now, energy_of(garment, cloth.particles()));
        }
        EXPECT_LT(most_now, most) << "window " << window << ", stretch " << stretch << ", bend " << bend;
        most = most_now;
      }
      Vec3 momentum = Vec3::Zero();
      for (int i = 0; i < garment.particle_count(); ++i)
        momentum += garment.masses[i] * cloth.particles().velocities[i];
      EXPECT_LT(momentum.norm(), (std::is_same_v<TypeParam, float> ? 3e-5 : 1e-12));
    }
}

TYPED_TEST(MeshXpbdTest, AStillHangingSheetStaysStill) {
  // What a pass in one direction only does not manage: see the header.
  Fabric fabric;
  fabric.stretch = 5000.0;
  fabric.bend = 0.0;
  const Garment garment = upright(20, fabric, true);
  MeshXpbd<TypeParam> cloth(garment);
  FrameInput input;
  input.substeps = 16;
  run(cloth, garment, input, 240);
  EXPECT_LT(spread(strains_of(garment, cloth.particles())).max, 0.02);
  const std::vector<Vec3> before = cloth.particles().positions;
  run(cloth, garment, input, 1);
  for (int i = 0; i < garment.particle_count(); ++i)
    EXPECT_LT((cloth.particles().positions[i] - before[i]).norm(), 1e-4);
}

TYPED_TEST(MeshXpbdTest, AHangingSheetGivesByItsOwnWeight) {
  // Over the length L the sheet gives rho g L^2 / (2 k), a little less where the held edge keeps it from narrowing.
  Fabric fabric;
  fabric.density = 0.2;
  fabric.stretch = 60.0;
  fabric.bend = 0.0;
  const double expected = fabric.density * 9.81 * k_size * k_size / (2.0 * fabric.stretch);
  for (const int cells : {10, 20}) {
    const Garment garment = upright(cells, fabric, true);
    MeshXpbd<TypeParam> cloth(garment);
    FrameInput input;
    input.substeps = 40;
    input.extra_drag = 5.0;
    run(cloth, garment, input, 240);
    double give = 0.0;
    int count = 0;
    for (int i = 0; i < garment.particle_count(); ++i) {
      if (garment.rest_positions[i].y() > 1.0 - k_size + 1e-9) continue;
      give += garment.rest_positions[i].y() - cloth.particles().positions[i].y();
      ++count;
    }
    EXPECT_NEAR(give / count, expected, 0.05 * expected) << cells;
  }
}

TYPED_TEST(MeshXpbdTest, TethersBoundTheStretch) {
  Fabric fabric;
  fabric.stretch = 20000.0;
  fabric.bend = 0.0;
  const Garment garment = upright(40, fabric, true);
  MeshXpbd<TypeParam> cloth(garment);
  FrameInput input;
  input.substeps = 2; // far too few for the springs alone
  run(cloth, garment, input, 60);
  for (const Tether& tether : build_tethers(garment)) {
    const auto& x = cloth.particles().positions;
    EXPECT_LE((x[tether.particle] - x[tether.anchor]).norm(), 1.021 * tether.length + 1e-5);
  }
}

/// How far the free end of a sheet clamped by its first two rows sinks, m, and how long it is from half a cell within
/// the clamp (the hinge at its rim stands for half a cell either way).
struct Cantilever {
  double sinks = 0.0, length = 0.0;
};
template <class Scalar> Cantilever cantilever(int cells, const Fabric& fabric, double length, int substeps) {
  const double width = 0.6 * length;
  MeshShape shape = app::mesh_sheet(cells, {0, 1, 0}, {width, 0, 0}, {0, 0, length});
  double step = length; // of the rows
  for (const Vec3& p : shape.positions)
    if (p.z() > 1e-9) step = std::min(step, p.z());
  for (Vec3& p : shape.positions) p.y() += p.z() < 1.5 * step ? 1e-6 : 0.0; // what is held is told by its height
  const Garment garment = garment_of(std::move(shape), fabric, 1.0 + 0.5e-6);
  MeshXpbd<Scalar> cloth(garment);
  FrameInput input;
  input.substeps = substeps;
  input.extra_drag = 10.0;
  run(cloth, garment, input, 180);
  double sinks = 0.0;
  int count = 0;
  for (int i = 0; i < garment.particle_count(); ++i) {
    if (garment.rest_positions[i].z() < length - 1e-9) continue;
    sinks += 1.0 - cloth.particles().positions[i].y();
    ++count;
  }
  return {sinks / count, length - 0.5 * step};
}

TYPED_TEST(MeshXpbdTest, AClampedSheetHoldsOutLikeACantilever_slow) {
  Fabric fabric;
  fabric.density = 0.2;
  fabric.stretch = 2000.0;
  fabric.bend = 0.6; // a board: q L^3 / (8 B) = 1/20
  fabric.drag = 0.0;
  for (const int cells : {4, 8}) {
    // Bending runs along a grid ever faster, with the square of its fineness, and substeps have to keep up.
    const Cantilever bent = cantilever<TypeParam>(cells, fabric, 0.5, cells * cells * 4);
    const double expected = fabric.density * 9.81 * std::pow(bent.length, 4) / (8.0 * fabric.bend);
    EXPECT_NEAR(bent.sinks, expected, 0.1 * expected) << cells;
  }
  fabric.bend = 0.0;
  EXPECT_GT(cantilever<TypeParam>(8, fabric, 0.5, 40).sinks, 0.3) << "without rigidity it hangs down";
}

TYPED_TEST(MeshXpbdTest, RunsAreRepeatable) {
  const Garment garment = upright(12, {}, true);
  std::uint64_t hashes[2] = {};
  for (std::uint64_t& hash : hashes) {
    MeshXpbd<TypeParam> cloth(garment);
    FrameInput input;
    input.substeps = 8;
    run(cloth, garment, input, 30);
    hash = state_hash(cloth.particles());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TYPED_TEST(MeshXpbdTest, FrictionHoldsUpToItsAngleAndSlidesBeyond) {
  for (const double friction : {0.3, 0.8}) {
    for (const double off : {-0.01, 0.01}) { // rad
      const double angle = std::atan(friction) + off;
      Fabric fabric;
      fabric.drag = 0.0;
      const Vec3 downhill(0.0, -std::sin(angle), std::cos(angle)), normal(0.0, std::cos(angle), std::sin(angle));
      const Garment garment =
          garment_of(app::mesh_sheet(6, fabric.contact_offset() * normal, {0.4, 0, 0}, 0.4 * downhill), fabric);
      MeshXpbd<TypeParam> cloth(garment);
      FrameInput input;
      input.substeps = 10;
      input.colliders.ground = proxies::Plane{normal, 0.0};
      const std::vector<double> coefficients = {friction};
      input.friction = coefficients;
      run(cloth, garment, input, 120);
      Vec3 moved = Vec3::Zero();
      for (int i = 0; i < garment.particle_count(); ++i)
        moved += (cloth.particles().positions[i] - garment.rest_positions[i]) / garment.particle_count();
      const double expected = off < 0.0 ? 0.0 : 0.5 * 9.81 * (std::sin(angle) - friction * std::cos(angle)) * 2.0 * 2.0;
      EXPECT_NEAR(moved.dot(downhill), expected, 0.05 * expected + 1e-3) << friction << " " << off;
    }
  }
}

TYPED_TEST(MeshXpbdTest, DivergenceIsCaughtInItsSubstep) {
  const Garment garment = upright(5, {}, true);
  MeshXpbd<TypeParam> cloth(garment);
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
  ASSERT_TRUE(divergence_of(result));
  EXPECT_EQ(divergence_of(result)->substep, 0);
}

TEST(MakeSolver, TakesTheOneForTrianglesWhereThereAreNoRows) {
  const Garment garment = upright(5, {}, true);
  EXPECT_NE(dynamic_cast<MeshXpbd<float>*>(make_solver(garment, {}).get()), nullptr);
  EXPECT_NE(dynamic_cast<MeshXpbd<double>*>(make_solver(garment, {.double_precision = true}).get()), nullptr);
  const auto springs = make_solver(garment, {.solver = SolverKind::mass_spring});
  run(*springs, garment, {}, 3);
}

} // namespace
