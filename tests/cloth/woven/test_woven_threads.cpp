// The line solve: a whole thread at once really solves its linear system, and steps of it close the threads.
#include "cloth/woven/sheet.h"
#include "tests/support/woven_cases.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::cloth;

namespace {

/// A tube of 16 lanes and one more block than needs be, whose threads alone hold.
Garment threads_only(int rows, double stretch) {
  Fabric fabric;
  fabric.bend = fabric.shear = 0.0;
  fabric.stretch = stretch;
  Garment garment = test::detail::tube(rows, 32, fabric, 0.8, std::nullopt);
  for (Spring& spring : garment.springs)
    if (std::abs(spring.i - spring.j) != garment.columns) spring.stiffness = 1e-25;
  return garment;
}

template <class T> Vec3 at(const WovenSheet<T>& sheet, int particle) {
  const std::ptrdiff_t element = sheet.element_of(particle);
  return {static_cast<double>(sheet.view().x[0][element]), static_cast<double>(sheet.view().x[1][element]),
          static_cast<double>(sheet.view().x[2][element])};
}

/// In disorder, particle k of every thread pinned for the given rows.
template <class T> WovenSheet<T> disordered(Garment& garment, const std::vector<int>& pinned_rows) {
  garment.pins.clear();
  for (const int row : pinned_rows)
    if (row < garment.rows)
      for (int column = 0; column < garment.columns; ++column)
        garment.pins.push_back({row * garment.columns + column, 0});
  std::mt19937_64 random(4);
  std::vector<Vec3> positions = garment.rest_positions;
  for (Vec3& p : positions) p += test::random_point(random, 0.005);
  WovenSheet<T> sheet(garment, false);
  sheet.set(positions, std::vector<Vec3>(positions.size(), Vec3::Zero()));
  return sheet;
}

template <class T> void solves_its_system(int rows, double stretch, double h, double bound) {
  for (const std::vector<int>& pinned : {std::vector<int>{}, {0}, {0, rows - 1}, {rows / 2}, {0, 1, 2}}) {
    Garment garment = threads_only(rows, stretch);
    const WovenSheet<T> sheet = disordered<T>(garment, pinned);
    const WovenSheetView<T>& view = sheet.view();
    std::vector<Vec3> before;
    for (int i = 0; i < garment.particle_count(); ++i) before.push_back(at(sheet, i));
    WovenStep<T> step;
    step.h = static_cast<T>(h);
    step.newton_steps = 1;
    step.closing_sweeps = 0;
    ASSERT_TRUE(woven_kernel<T>().constraints(view, step));

    const int n = garment.columns, edges = rows - 1, last_block = view.blocks - 1;
    const auto flags = pinned_flags(garment);
    for (int lane = 0; lane < view.lanes; ++lane) { // with one pass the last block's multipliers are still there
      const int column = lane * view.blocks + last_block;
      Eigen::MatrixXd system = Eigen::MatrixXd::Zero(edges, edges);
      Eigen::VectorXd right(edges), found(edges);
      std::vector<Vec3> direction;
      std::vector<double> weight;
      for (int row = 0; row < rows; ++row)
        weight.push_back(flags[row * n + column] ? 0.0 : 1.0 / garment.masses[row * n + column]);
      for (int k = 0; k < edges; ++k) {
        const Vec3 edge = before[(k + 1) * n + column] - before[k * n + column];
        const auto spring = std::find_if(garment.springs.begin(), garment.springs.end(), [&](const Spring& s) {
          return s.i == k * n + column && s.j == s.i + n && s.kind == SpringKind::structural;
        });
        ASSERT_NE(spring, garment.springs.end());
        direction.push_back(edge.normalized());
        right[k] = edge.norm() - spring->rest_length;
        system(k, k) = weight[k] + weight[k + 1] + 1.0 / (spring->stiffness * h * h);
        if (k > 0) system(k, k - 1) = system(k - 1, k) = -weight[k] * direction[k].dot(direction[k - 1]);
        found[k] = static_cast<double>(view.multipliers[0][k * k_lanes + lane]);
      }
      EXPECT_LT((system * found - right).cwiseAbs().maxCoeff(), bound * right.cwiseAbs().maxCoeff()) << "lane " << lane;
      const Eigen::VectorXd exact = system.partialPivLu().solve(right);
      for (int row = 0; row < rows; ++row) { // x moves by M^-1 J^T dlambda
        Vec3 way = Vec3::Zero();
        if (row < edges) way += weight[row] * exact[row] * direction[row];
        if (row > 0) way -= weight[row] * exact[row - 1] * direction[row - 1];
        EXPECT_LT((at(sheet, row * n + column) - before[row * n + column] - way).norm(), 20.0 * bound * 0.01);
      }
    }
  }
}

TEST(WovenThreads, SolveTheirSystemToRounding) {
  for (const int rows : {2, 3, 17, 80})
    for (const double stretch : {5.0, 40.0, 5e4}) {
      SCOPED_TRACE(std::to_string(rows) + " rows, " + std::to_string(stretch) + " N/m");
      solves_its_system<double>(rows, stretch, 1.0 / 600.0, 1e-11);
      solves_its_system<float>(rows, stretch, 1.0 / 600.0, 1e-3);
    }
}

/// C - at lambda of the worst edge after this many Newton steps, m.
double residual_after(int steps) {
  Garment garment = threads_only(30, 2000.0);
  const WovenSheet<double> sheet = disordered<double>(garment, {0});
  const WovenSheetView<double>& view = sheet.view();
  WovenStep<double> step;
  step.h = 1.0 / 600.0;
  step.newton_steps = steps;
  step.closing_sweeps = 0;
  EXPECT_TRUE(woven_kernel<double>().constraints(view, step));
  double worst = 0.0;
  for (int lane = 0; lane < view.lanes; ++lane)
    for (const Spring& spring : garment.springs) {
      if (spring.j != spring.i + garment.columns || spring.i % garment.columns != lane * view.blocks + view.blocks - 1)
        continue;
      const double c = (at(sheet, spring.j) - at(sheet, spring.i)).norm() - spring.rest_length;
      const double lambda = view.multipliers[0][spring.i / garment.columns * k_lanes + lane];
      worst = std::max(worst, std::abs(c - lambda / (spring.stiffness * step.h * step.h)));
    }
  return worst;
}

TEST(WovenThreads, NewtonStepsMakeTheResidualVanish) {
  EXPECT_GT(residual_after(1), 1e-5);
  EXPECT_LT(residual_after(30), 1e-15 * 30);
}

} // namespace
