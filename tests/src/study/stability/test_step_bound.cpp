// The closed form of mass_spring's largest step, against dense matrices and against the solver itself.
#include "cloth/garment/springs.h"
#include "cloth/garment/vibration.h"
#include "src/study/stability/step_bound.h"
#include "src/study/stability/trials.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;

namespace {

/// rad/s. K by central differences of the solver's own forces, column by column; pinned particles left out.
double dense_fastest_vibration(const cloth::Garment& garment) {
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment);
  std::vector<int> free;
  for (int i = 0; i < garment.particle_count(); ++i)
    if (!pinned[i]) free.push_back(i);
  const auto size = static_cast<Eigen::Index>(3 * free.size());
  Eigen::MatrixXd matrix(size, size);
  const double step = 1e-7;
  for (Eigen::Index column = 0; column < size; ++column) {
    std::array<std::vector<Vec3>, 2> forces;
    for (int side = 0; side < 2; ++side) {
      std::vector<Vec3> positions = garment.rest_positions;
      positions[free[column / 3]][column % 3] += side ? step : -step;
      forces[side].assign(positions.size(), Vec3::Zero());
      cloth::add_spring_forces(garment, positions, forces[side]);
    }
    for (Eigen::Index row = 0; row < size; ++row) {
      const double slope = (forces[1][free[row / 3]] - forces[0][free[row / 3]])[row % 3] / (2.0 * step);
      matrix(row, column) = -slope / std::sqrt(garment.masses[free[row / 3]] * garment.masses[free[column / 3]]);
    }
  }
  const Eigen::MatrixXd symmetric = 0.5 * (matrix + matrix.transpose());
  return std::sqrt(
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

Patch patch_of(double stretch, double cell) {
  Patch patch;
  patch.fabric.stretch = stretch;
  patch.cell = cell;
  patch.solver.solver = cloth::SolverKind::mass_spring;
  return patch;
}

TEST(StepBound, TheFastestVibrationIsThatOfTheDenseMatrix) {
  for (const double stretch : {40.0, 1000.0}) {
    const cloth::Garment garment = garment_of(patch_of(stretch, 0.02));
    const double dense = dense_fastest_vibration(garment);
    EXPECT_NEAR(cloth::fastest_vibration(garment), dense, 1e-3 * dense);
  }
}

TEST(StepBound, TheSolversLargestStepIsWithinFivePerCentOfTheBound) {
  const Patch patch = patch_of(1000.0, 0.02);
  // What the patch hangs in takes 3 / s besides the fabric's own drag.
  const double bound = largest_stable_step(dense_fastest_vibration(garment_of(patch)), patch.fabric.drag + 3.0);
  const LargestStep found = find_largest_step(
      [&](double step) {
        Patch at = patch;
        at.step = step;
        return hang(at, 1);
      },
      0.3 * bound, 3.0 * bound, 1.01);
  RecordProperty("found_over_bound", std::to_string(found.step / bound));
  EXPECT_NEAR(found.step, bound, 0.05 * bound);
  EXPECT_NE(found.beyond, Outcome::held);
}

TEST(StepBound, ASeamIsOneParticle) {
  cloth::GarmentDescription description;
  description.name = "tube";
  cloth::TubeShape shape;
  shape.rows = shape.columns = 9;
  shape.rings = {{1.0, 0.2, 0.2, 0, 0}, {0.7, 0.2, 0.2, 0, 0}};
  description.shape = shape;
  const double shut = cloth::fastest_vibration(cloth::build_garment(description));
  std::get<cloth::TubeShape>(description.shape).columns = 10; // the last lies on the first
  std::get<cloth::TubeShape>(description.shape).seam = 1.0;
  const cloth::Garment sewn = cloth::build_garment(description);
  ASSERT_EQ(sewn.seams.size(), 9u);
  // The same cloth but for bending across the seam, and its edge that is there twice.
  EXPECT_NEAR(cloth::fastest_vibration(sewn), shut, 0.05 * shut);
}

TEST(StepBound, DragShortensTheStepAsTheSchemeSays) {
  EXPECT_DOUBLE_EQ(largest_stable_step(10.0, 0.0), 0.2);
  const double h = largest_stable_step(10.0, 3.0);
  EXPECT_NEAR(h * h * 100.0 + 2.0 * h * 3.0, 4.0, 1e-12);
}

TEST(StepBound, WhatHasNoSpringsHasNoBound) {
  cloth::Garment garment = garment_of(patch_of(40.0, 0.02));
  garment.springs.clear();
  garment.structural_count = 0;
  EXPECT_TRUE(std::isinf(largest_stable_step(garment)));
}

TEST(LargestStep, BisectionFindsWhereItStopsToHold) {
  int asked = 0;
  const LargestStep found = find_largest_step(
      [&](double step) {
        ++asked;
        return step <= 0.0123 ? Outcome::held : Outcome::stretched;
      },
      1e-4, 1.0, 1.01);
  EXPECT_LE(found.step, 0.0123);
  EXPECT_GT(found.step * 1.01, 0.0123);
  EXPECT_EQ(found.beyond, Outcome::stretched);
  EXPECT_LT(asked, 14);
}

TEST(LargestStep, BothEndsAreTold) {
  EXPECT_EQ(find_largest_step([](double) { return Outcome::diverged; }, 1e-4, 1.0, 1.01).step, 0.0);
  const LargestStep all = find_largest_step([](double) { return Outcome::held; }, 1e-4, 1.0, 1.01);
  EXPECT_EQ(all.step, 1.0);
  EXPECT_EQ(all.beyond, Outcome::held);
}

} // namespace
