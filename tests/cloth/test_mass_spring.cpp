#include "cloth/garment/springs.h"
#include "cloth/mass_spring.h"
#include "cloth/metrics.h"
#include "proxies/distance/signed_distance.h"

#include <gtest/gtest.h>
#include <numeric>
#include <random>

using namespace tutu;
using namespace tutu::cloth;

namespace {

Garment sheet(int n, std::vector<Attachment> attachments = {}, Fabric fabric = {}) {
  GarmentDescription description;
  description.file = "sheet";
  description.shape = GridShape{n, n, {-0.25, 1, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}};
  description.attachments = std::move(attachments);
  description.fabric = fabric;
  return build_garment(description);
}

std::vector<Vec3> shaken(std::vector<Vec3> positions, double by, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> shift(-by, by);
  for (Vec3& p : positions) p += Vec3(shift(random), shift(random), shift(random));
  return positions;
}

const std::unique_ptr<proxies::CollisionQuery>& brute() {
  static const auto query = proxies::make_query(proxies::Backend::brute);
  return query;
}

TEST(MassSpring, ForcesAreTheGradientOfTheEnergy) {
  const Garment garment = sheet(6);
  const std::vector<Vec3> at = shaken(garment.rest_positions, 0.03, 1);
  std::vector<Vec3> forces(at.size(), Vec3::Zero());
  EXPECT_FALSE(add_spring_forces(garment, at, forces).has_value());
  const double step = 1e-6;
  for (std::size_t i = 0; i < at.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Vec3> ahead = at, behind = at;
      ahead[i][axis] += step;
      behind[i][axis] -= step;
      const double slope = (elastic_energy(garment, ahead) - elastic_energy(garment, behind)) / (2.0 * step);
      EXPECT_NEAR(forces[i][axis], -slope, 1e-6 * (1.0 + forces[i].norm()));
    }
}

TEST(MassSpring, SpringForcesKeepMomentumAndAngularMomentum) {
  const Garment garment = sheet(8);
  const std::vector<Vec3> at = shaken(garment.rest_positions, 0.05, 2);
  std::vector<Vec3> forces(at.size(), Vec3::Zero());
  add_spring_forces(garment, at, forces);
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  for (std::size_t i = 0; i < at.size(); ++i) {
    sum += forces[i];
    torque += at[i].cross(forces[i]);
  }
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_LT(torque.norm(), 1e-12);
}

TEST(MassSpring, DampersTakeEnergyAndNoMomentum) {
  const Garment garment = sheet(8);
  const std::vector<Vec3> at = shaken(garment.rest_positions, 0.03, 3);
  const std::vector<Vec3> v = shaken(std::vector<Vec3>(at.size(), Vec3::Zero()), 1.0, 4);
  std::vector<Vec3> forces(at.size(), Vec3::Zero());
  constexpr double k_time = 0.002;
  add_damping_forces(garment, at, v, k_time, forces);
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  double power = 0.0, expected = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    sum += forces[i];
    torque += at[i].cross(forces[i]);
    power += v[i].dot(forces[i]);
  }
  for (const Spring& spring : garment.springs) {
    const double rate = (v[spring.j] - v[spring.i]).dot((at[spring.j] - at[spring.i]).normalized());
    expected -= spring.stiffness * k_time * rate * rate;
  }
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_LT(torque.norm(), 1e-12);
  EXPECT_LT(expected, 0.0);
  EXPECT_NEAR(power, expected, 1e-12 * -expected);
}

TEST(MassSpring, DampersLeaveWhatMovesAndTurnsAsAWhole) {
  const Garment garment = sheet(8);
  const std::vector<Vec3> at = shaken(garment.rest_positions, 0.03, 5);
  std::vector<Vec3> v;
  for (const Vec3& x : at) v.push_back(Vec3(1, -2, 3) + Vec3(4, 5, -6).cross(x));
  std::vector<Vec3> forces(at.size(), Vec3::Zero());
  add_damping_forces(garment, at, v, 0.002, forces);
  for (const Vec3& force : forces) EXPECT_LT(force.norm(), 1e-12);
}

TEST(MassSpring, FreeFallIsThatOfTheScheme) {
  Fabric fabric;
  fabric.drag = 0.0;
  const Garment garment = sheet(5, {}, fabric);
  MassSpring cloth(garment);
  FrameInput input;
  input.substeps = 7;
  const int frames = 30;
  for (int f = 0; f < frames; ++f) ASSERT_FALSE(cloth.step(input, *brute()).has_value());
  // Semi-implicit Euler after n steps h: v = g n h, x = x0 + g h^2 n (n + 1) / 2.
  const double h = input.seconds / input.substeps, n = frames * input.substeps;
  const double total_mass = std::accumulate(garment.masses.begin(), garment.masses.end(), 0.0);
  Vec3 momentum = Vec3::Zero();
  for (int i = 0; i < garment.particle_count(); ++i) {
    momentum += garment.masses[i] * cloth.particles().velocities[i];
    EXPECT_LT(
        (cloth.particles().positions[i] - garment.rest_positions[i] - input.gravity * (h * h * n * (n + 1) / 2)).norm(),
        1e-10);
  }
  EXPECT_LT((momentum - total_mass * n * h * input.gravity).norm(), 1e-12 * n);
}

TEST(MassSpring, DragEndsAtTheTerminalSpeed) {
  Fabric fabric;
  fabric.drag = 5.0;
  const Garment garment = sheet(4, {}, fabric);
  MassSpring cloth(garment);
  FrameInput input;
  for (int f = 0; f < 600; ++f) cloth.step(input, *brute());
  for (const Vec3& v : cloth.particles().velocities) EXPECT_NEAR(v.y(), -9.81 / 5.0, 1e-9);
}

TEST(MassSpring, PinsGoWhereTheyAreTold) {
  const Garment garment = sheet(5, {{"Hips", 0, 0, 0, -1}});
  MassSpring cloth(garment);
  std::vector<Vec3> start, end;
  for (const Pin& pin : garment.pins) {
    start.push_back(garment.rest_positions[pin.particle]);
    end.push_back(start.back() + Vec3(0.01, 0.02, 0.0));
  }
  FrameInput input;
  input.pins_start = start;
  input.pins_end = end;
  ASSERT_FALSE(cloth.step(input, *brute()).has_value());
  for (std::size_t k = 0; k < end.size(); ++k) EXPECT_EQ(cloth.particles().positions[garment.pins[k].particle], end[k]);
}

TEST(MassSpring, ASeamKeepsItsSidesTogetherAndTheMomentum) {
  GarmentDescription description;
  description.file = "tube";
  TubeShape shape;
  shape.rows = 9;
  shape.columns = 9;
  shape.rings = {{1.0, 0.2, 0.2, 0, 0}, {0.6, 0.3, 0.3, 0, 0}};
  shape.seam = 1.0 / 3.0;
  description.shape = shape;
  description.fabric.drag = 0.0;
  const Garment garment = build_garment(description);
  ASSERT_EQ(garment.seams.size(), 3u);
  MassSpring cloth(garment);
  cloth.reset(shaken(garment.rest_positions, 0.01, 3));
  FrameInput input;
  input.substeps = 40;
  input.gravity.setZero();
  for (int f = 0; f < 20; ++f) ASSERT_FALSE(cloth.step(input, *brute()).has_value());
  Vec3 momentum = Vec3::Zero();
  for (int i = 0; i < garment.particle_count(); ++i) momentum += garment.masses[i] * cloth.particles().velocities[i];
  EXPECT_LT(momentum.norm(), 1e-13);
  for (const Seam& seam : garment.seams) {
    EXPECT_EQ(cloth.particles().positions[seam.i], cloth.particles().positions[seam.j]);
    EXPECT_EQ(cloth.particles().velocities[seam.i], cloth.particles().velocities[seam.j]);
  }
}

TEST(MassSpring, DivergenceIsCaughtInItsSubstep) {
  Fabric fabric;
  fabric.stretch = 1e6; // far beyond what 5 substeps a frame can carry
  const Garment garment = sheet(10, {{"Hips", 0, 0, 0, -1}}, fabric);
  MassSpring cloth(garment);
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  FrameInput input;
  input.pins_start = input.pins_end = pins;
  std::optional<Unfinished> end;
  for (int f = 0; f < 100 && !end; ++f) end = cloth.step(input, *brute());
  const Divergence* divergence = divergence_of(end);
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->trouble, Trouble::long_edge);
  EXPECT_GT(divergence->stretch(), 10.0);
  EXPECT_GT(divergence->strongest_force, 0.0);
  EXPECT_EQ(divergence->position, cloth.particles().positions[divergence->particle]);
}

TEST(MassSpring, ANumberThatIsNoneIsADivergenceToo) {
  const Garment garment = sheet(4);
  std::vector<Vec3> forces(garment.rest_positions.size(), Vec3::Zero()), positions = garment.rest_positions;
  positions[5].x() = std::nan("");
  EXPECT_TRUE(add_spring_forces(garment, positions, forces).has_value());
}

/// A limb that sweeps under a falling sheet, for every backend.
struct Drop {
  Particles particles;
  ContactCounts counts;
};

Drop drop_on_limb(proxies::Backend backend, int frames) {
  static const Garment garment = sheet(20);
  MassSpring cloth(garment);
  const auto query = proxies::make_query(backend);
  FrameInput input;
  input.substeps = 16;
  for (int f = 0; f < frames; ++f) {
    const auto limb = [](double t) {
      const Vec3 shift(0.1 * std::sin(6.0 * t), 0, 0);
      return std::vector<proxies::Capsule>{{Vec3(-0.2, 0.9, -0.1) + shift, Vec3(0.2, 0.85, 0.1) + shift, 0.06},
                                           {Vec3(0.1, 0.8, 0.1), Vec3(0.1, 0.8, 0.1), 0.1}};
    };
    const auto start = limb(f / 60.0), end = limb((f + 1) / 60.0);
    input.colliders = {start, end, proxies::Plane{Vec3::UnitY(), 0.6}};
    EXPECT_FALSE(cloth.step(input, *query).has_value());
  }
  return {cloth.particles(), cloth.contact_counts()};
}

TEST(MassSpring, RunsAreRepeatableAndSkipMostPairs) {
  const Drop run = drop_on_limb(proxies::Backend::brute, 60);
  EXPECT_GT(run.counts.contacts, 1000);
  EXPECT_LT(run.counts.queries, run.counts.candidates * 16 / 3) << "of the pairs that could meet";
  EXPECT_EQ(state_hash(run.particles), state_hash(drop_on_limb(proxies::Backend::brute, 60).particles));
}

TEST(MassSpring, BackendsAgree) {
  const Drop brute_run = drop_on_limb(proxies::Backend::brute, 40), fcl_run = drop_on_limb(proxies::Backend::fcl, 40);
  double farthest = 0.0;
  for (int i = 0; i < brute_run.particles.count(); ++i)
    farthest = std::max(farthest, (brute_run.particles.positions[i] - fcl_run.particles.positions[i]).norm());
  EXPECT_LT(farthest, 1e-6);
  EXPECT_LE(fcl_run.counts.candidates, brute_run.counts.candidates);
}

} // namespace
