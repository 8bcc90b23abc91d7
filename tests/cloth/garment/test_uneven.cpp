// Uneven starts: what they move, and that without them symmetric cloth never buckles.
#include "cloth/garment/uneven.h"
#include "cloth/solver.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::cloth;

namespace {

/// An upright strip in the plane z = 0, held along its first and its last row.
Garment strip() {
  GarmentDescription description;
  description.shape = GridShape{24, 16, {-0.15, 1.46, 0}, {0.3, 0, 0}, {0, -0.46, 0}};
  description.attachments = {{"stage", 0, 0, 0, -1}, {"stage", -1, -1, 0, -1}};
  return build_garment(description);
}

TEST(Uneven, MovesFreeParticlesByUpToAsMuch) {
  const Garment garment = strip();
  std::vector<Vec3> positions = garment.rest_positions, again = positions, other = positions;
  std::mt19937_64 random(3), same(3), another(4);
  make_uneven(garment, 0.002, random, positions);
  make_uneven(garment, 0.002, same, again);
  make_uneven(garment, 0.002, another, other);
  EXPECT_EQ(positions, again);
  EXPECT_NE(positions, other);
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  Vec3 mean = Vec3::Zero(), squares = Vec3::Zero();
  int free = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 off = positions[i] - garment.rest_positions[i];
    if (pinned[i]) {
      EXPECT_EQ(off, Vec3::Zero());
      continue;
    }
    EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.002 + 1e-15);
    mean += off;
    squares += off.cwiseProduct(off);
    ++free;
  }
  ASSERT_EQ(free, 22 * 16);
  for (int axis = 0; axis < 3; ++axis) { // of an even distribution: 0, and a third of the square of the most
    EXPECT_NEAR(mean[axis] / free, 0.0, 3.0 * 0.002 / std::sqrt(3.0 * free));
    EXPECT_NEAR(squares[axis] / free, 0.002 * 0.002 / 3.0, 0.15 * 0.002 * 0.002 / 3.0);
  }
}

/// How far the strip leaves its plane, m, each way, when its rows are brought nearer by a tenth within half a second.
std::pair<double, double> buckled(double uneven, std::uint64_t seed, const SolverOptions& options) {
  const Garment garment = strip();
  std::vector<Vec3> start = garment.rest_positions;
  std::mt19937_64 random(seed);
  make_uneven(garment, uneven, random, start);
  const auto solver = make_solver(garment, options);
  solver->reset(start);
  const auto query = proxies::make_query(proxies::Backend::hybrid);
  std::vector<Vec3> before, after;
  for (const Pin& pin : garment.pins) after.push_back(garment.rest_positions[pin.particle]);
  FrameInput input;
  input.substeps = options.solver == SolverKind::xpbd ? 12 : 60;
  for (int frame = 0; frame < 60; ++frame) {
    before = after;
    if (frame < 30)
      for (std::size_t k = 0; k < after.size() / 2; ++k) after[k].y() -= 0.046 / 30.0;
    input.pins_start = before;
    input.pins_end = after;
    EXPECT_FALSE(solver->step(input, *query)) << frame;
  }
  std::pair<double, double> most = {0.0, 0.0};
  for (const Vec3& p : solver->particles().positions)
    most = {std::max(most.first, -p.z()), std::max(most.second, p.z())};
  return most;
}

TEST(Uneven, OnlyAnUnevenStartLetsSymmetricClothBuckle) {
  for (const auto solver : {SolverKind::xpbd, SolverKind::mass_spring}) {
    SolverOptions options;
    options.solver = solver;
    EXPECT_EQ(buckled(0.0, 1, options), std::pair(0.0, 0.0)) << "pressed flat, to the last bit: " << name_of(solver);
    const auto [back, front] = buckled(k_unevenness, 1, options);
    EXPECT_GT(std::max(back, front), 0.02) << name_of(solver);
    EXPECT_EQ(buckled(k_unevenness, 1, options), std::pair(back, front)) << "the seed alone decides";
    EXPECT_NE(buckled(k_unevenness, 2, options), std::pair(back, front));
  }
}

} // namespace
