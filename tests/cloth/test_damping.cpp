// How a substep answers: what it takes back, and which way edges pull.
#include "cloth/damping.h"
#include "cloth/mesh_xpbd.h"
#include "cloth/xpbd.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tutu::cloth {
namespace {

Garment sheet(int cells, double damping) {
  GarmentDescription description;
  description.shape = GridShape{cells + 1, cells + 1, Vec3(0, 1, 0), Vec3(0.5, 0, 0), Vec3(0, -0.5, 0)};
  description.attachments = {{.joint = "stage", .last_row = 0}};
  description.fabric.damping = damping;
  return build_garment(description);
}

/// Of a vibration solved by taken and C(was) alone, v <- (x' - x) / h: how fast its amplitude falls, 1/s.
double decay_of(double taken, double w, double h) {
  double x = 1.0, v = 0.0, most = 0.0;
  const int steps = static_cast<int>(std::lround(1.0 / h));
  for (int k = 0; k < steps; ++k) {
    // x' = x + h v - h^2 w^2 (taken x' + (1 - taken) x) / taken, the multiplier of compliance 1 / (m w^2) and target C
    // - (1 - taken) C(was)
    const double stiff = h * h * w * w / taken;
    const double next = (x + h * v + stiff * (1.0 - taken) * x) / (1.0 + stiff);
    v = (next - x) / h;
    x = next;
    if (k > steps / 2) most = std::max(most, std::hypot(x, v / w));
  }
  return -std::log(most) / 0.5;
}

TEST(Damping, IsThatOfTheFabricInAnySubstep) {
  constexpr double k_damping = 0.002, k_w = 30.0;
  const Damping damping(sheet(4, k_damping));
  const double expected = 0.5 * k_damping * k_w * k_w;
  for (const int substeps : {9, 12, 24, 48, 400}) {
    const double h = 1.0 / 60.0 / substeps;
    EXPECT_NEAR(decay_of(damping.at(h).taken, k_w, h), expected, 0.1 * expected) << substeps;
  }
}

TEST(Damping, NeverTakesBackMoreThanThereIs) {
  EXPECT_DOUBLE_EQ(Damping(sheet(4, 0.0)).at(1e-4).taken, 1.0);
  EXPECT_DOUBLE_EQ(Damping(sheet(4, 0.002)).at(0.1).taken, 1.0);
  EXPECT_DOUBLE_EQ(Damping(sheet(4, 0.002)).at(0.0005).taken, 0.25);
}

/// Of a free sheet in empty space, w about its normal: the share of its angular momentum that a second leaves.
double spin_kept(const Garment& garment, Solver& solver, double w, int substeps) {
  Particles state{garment.rest_positions, garment.rest_positions};
  for (Vec3& v : state.velocities) v = Vec3(0, 0, w).cross(v);
  solver.restore(state);
  FrameInput input;
  input.gravity = Vec3::Zero();
  input.substeps = substeps;
  const auto query = proxies::make_query(proxies::Backend::brute);
  const auto momentum = [&](const Particles& particles) {
    double sum = 0.0;
    for (int i = 0; i < particles.count(); ++i)
      sum += garment.masses[i] * particles.positions[i].cross(particles.velocities[i]).z();
    return sum;
  };
  for (int frame = 0; frame < 60; ++frame)
    if (solver.step(input, *query)) return 0.0;
  return momentum(solver.particles()) / momentum(state);
}

TEST(Turning, IsNotDamped_slow) {
  GarmentDescription description;
  description.shape = GridShape{13, 13, Vec3(-0.15, 0.15, 0), Vec3(0.3, 0, 0), Vec3(0, -0.3, 0)};
  description.fabric.drag = 0.0;
  const Garment garment = build_garment(description);
  for (const double w : {3.0, 10.0, 20.0})
    for (const int substeps : {6, 12, 48}) {
      SCOPED_TRACE(std::to_string(w) + " rad/s, " + std::to_string(substeps) + " substeps");
      SolverOptions options;
      EXPECT_NEAR(spin_kept(garment, *make_xpbd(garment, options), w, substeps), 1.0, 2e-3); // its rounding
      options.double_precision = true;
      EXPECT_NEAR(spin_kept(garment, *make_xpbd(garment, options), w, substeps), 1.0, 1e-4);
      MeshXpbd<float> single(garment);
      EXPECT_NEAR(spin_kept(garment, single, w, substeps), 1.0, 3e-3); // rounding shows as strain, which is damped
      MeshXpbd<double> twice(garment);
      EXPECT_NEAR(spin_kept(garment, twice, w, substeps), 1.0, 1e-4);
    }
}

} // namespace
} // namespace tutu::cloth
