#include "cloth/garment/dihedral.h"
#include "cloth/garment/elements.h"

#include <gtest/gtest.h>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

using namespace tutu;
using namespace tutu::cloth;

namespace {

GarmentDescription described(std::variant<GridShape, TubeShape, DiscShape, MeshShape> shape) {
  GarmentDescription description;
  description.file = "test";
  description.shape = std::move(shape);
  return description;
}

DiscShape disc(int rings, double hole = 0.0) { return {{0, 1, 0}, 0.15, 0.15, rings, hole}; }

TEST(Dihedral, GradientsAreThoseOfFiniteDifferences) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> gauss;
  const double step = 1e-6;
  int folded = 0;
  for (int trial = 0; trial < 500; ++trial) {
    std::array<Vec3, 4> x;
    for (Vec3& p : x) p = {gauss(random), gauss(random), gauss(random)};
    const auto at = dihedral<double>(x[0], x[1], x[2], x[3]);
    if (std::abs(at.angle()) > 3.0) continue; // the angle jumps at pi
    folded += std::abs(at.angle()) > 0.5 * std::numbers::pi;
    const std::array<Vec3, 4> gradients = {at.at_a, at.at_b, at.at_c, at.at_d};
    for (int corner = 0; corner < 4; ++corner)
      for (int axis = 0; axis < 3; ++axis) {
        auto ahead = x, behind = x;
        ahead[corner][axis] += step;
        behind[corner][axis] -= step;
        const double slope = (dihedral<double>(ahead[0], ahead[1], ahead[2], ahead[3]).angle() -
                              dihedral<double>(behind[0], behind[1], behind[2], behind[3]).angle()) /
                             (2.0 * step);
        const double tolerance = 1e-5 * (1.0 + std::pow(gradients[corner].norm(), 3));
        EXPECT_NEAR(gradients[corner][axis], slope, tolerance) << "trial " << trial << " corner " << corner;
      }
  }
  EXPECT_GT(folded, 100);
}

TEST(Dihedral, IsZeroWhenFlatAndOddInTheSide) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0.3, 1, 0);
  EXPECT_EQ(dihedral<double>(a, b, c, Vec3(0.6, -1, 0)).angle(), 0.0);
  const double up = dihedral<double>(a, b, c, Vec3(0.6, -1, 0.5)).angle();
  EXPECT_NEAR(up, -dihedral<double>(a, b, c, Vec3(0.6, -1, -0.5)).angle(), 1e-15);
  EXPECT_NEAR(std::abs(up), std::atan(0.5), 1e-15);
  const auto none = dihedral<double>(a, b, Vec3(0.5, 0, 0), Vec3(0.6, -1, 0.5));
  EXPECT_EQ(none.angle(), 0.0);
  EXPECT_EQ(none.at_c, Vec3::Zero());
}

TEST(Bends, AnEdgeBetweenTwoTrianglesIsAHinge) {
  const Garment garment = build_garment(described(GridShape{5, 7, {0, 1, 0}, {0.6, 0, 0}, {0, -0.4, 0}}));
  const std::vector<Edge> edges = edges_of(garment.triangles);
  int borders = 0;
  for (const Edge& edge : edges) borders += edge.triangles == 1;
  EXPECT_EQ(borders, 2 * (4 + 6));
  const std::vector<Bend> bends = build_bends(garment);
  EXPECT_EQ(bends.size(), edges.size() - static_cast<std::size_t>(borders));
  for (const Bend& bend : bends) {
    EXPECT_EQ(std::set<int>({bend.a, bend.b, bend.c, bend.d}).size(), 4u);
    EXPECT_EQ(bend.rest_angle, 0.0);
    EXPECT_GT(bend.stiffness, 0.0);
  }
}

/// Energy of the hinges when `garment` is bent to a cylinder of curvature kappa along x, J.
double rolled_energy(const Garment& garment, double kappa) {
  std::vector<Vec3> x = garment.rest_positions;
  for (Vec3& p : x) p = Vec3(std::sin(kappa * p.x()) / kappa, p.y() + (1.0 - std::cos(kappa * p.x())) / kappa, p.z());
  double energy = 0.0;
  for (const Bend& bend : build_bends(garment)) {
    const double angle = dihedral<double>(x[bend.a], x[bend.b], x[bend.c], x[bend.d]).angle();
    energy += 0.5 * bend.stiffness * angle * angle;
  }
  return energy;
}

TEST(Bends, ABentSheetStoresItsRigidityHoweverFine) {
  const double kappa = 2.0;
  for (const int n : {10, 30, 90}) {
    GarmentDescription grid = described(GridShape{n, n, {-0.25, 1, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}});
    grid.fabric.bend = 3e-5;
    EXPECT_NEAR(rolled_energy(build_garment(grid), kappa) / (0.5 * 3e-5 * kappa * kappa * 0.25), 1.0, 1.5 / n) << n;
  }
  for (const int rings : {8, 30}) {
    GarmentDescription round = described(disc(rings));
    round.fabric.bend = 3e-5;
    const double area = std::numbers::pi * 0.15 * 0.15;
    EXPECT_NEAR(rolled_energy(build_garment(round), kappa) / (0.5 * 3e-5 * kappa * kappa * area), 1.1, 0.05)
        << rings << " rings: where triangles are not quite equilateral, hinges are a little too stiff";
  }
}

TEST(Bends, OnlyPressedClothKeepsItsAngles) {
  TubeShape tube;
  tube.rows = 4;
  tube.columns = 12;
  tube.rings = {{1.0, 0.2, 0.2, 0, 0}, {0.6, 0.2, 0.2, 0, 0}};
  const Garment woven = build_garment(described(tube));
  for (const Bend& bend : build_bends(woven)) EXPECT_EQ(bend.rest_angle, 0.0);
  MeshShape mesh{woven.rest_positions, woven.triangles, true};
  double turn = 0.0;
  for (const Bend& bend : build_bends(build_garment(described(mesh)))) turn += std::abs(bend.rest_angle);
  EXPECT_NEAR(turn, 3 * 2.0 * std::numbers::pi, 1e-9) << "once around in each of three rows of cells";
}

TEST(Bends, ThereAreNoneWithoutRigidity) {
  GarmentDescription description = described(disc(4));
  description.fabric.bend = 0.0;
  EXPECT_TRUE(build_bends(build_garment(description)).empty());
}

TEST(Tethers, LeadToTheNearestPinAlongTheCloth) {
  const int rows = 9, columns = 7;
  GarmentDescription description = described(GridShape{rows, columns, {0, 1, 0}, {0.6, 0, 0}, {0, -0.8, 0}});
  EXPECT_TRUE(build_tethers(build_garment(description)).empty()) << "nothing is pinned";
  description.attachments = {{"Hips", 0, 0, 0, -1}};
  const Garment garment = build_garment(description);
  const std::vector<Tether> tethers = build_tethers(garment);
  ASSERT_EQ(tethers.size(), static_cast<std::size_t>((rows - 1) * columns));
  for (const Tether& tether : tethers) {
    EXPECT_EQ(tether.anchor, tether.particle % columns) << "straight up";
    EXPECT_NEAR(tether.length, 0.1 * (tether.particle / columns), 1e-12);
  }
}

TEST(Tethers, AreNeverShorterThanTheStraightWayAndLittleLongerThanTheShortest) {
  GarmentDescription description = described(disc(20));
  description.attachments.emplace_back();
  description.attachments.back().within = Attachment::Ball{{0, 1, 0}, 0.02};
  const Garment garment = build_garment(description);
  EXPECT_GT(garment.pins.size(), 6u);
  const std::vector<Tether> tethers = build_tethers(garment);
  EXPECT_EQ(tethers.size() + garment.pins.size(), garment.rest_positions.size());
  for (const Tether& tether : tethers) {
    const double straight = (garment.rest_positions[tether.particle] - garment.rest_positions[tether.anchor]).norm();
    EXPECT_GE(tether.length, straight * (1.0 - 1e-12));
    EXPECT_LE(tether.length, 1.16 * straight) << "of equilateral triangles, edges go two sides of a rhombus at worst";
  }
}

TEST(Tethers, GoThroughSeams) {
  TubeShape tube;
  tube.rows = 4;
  tube.columns = 21;
  tube.rings = {{1.0, 0.2, 0.2, 0, 0}, {0.7, 0.2, 0.2, 0, 0}};
  tube.seam = 1.0;
  GarmentDescription description = described(tube);
  description.attachments = {{"Hips", 0, 0, 0, 0}}; // one corner
  double longest = 0.0;
  for (const Tether& tether : build_tethers(build_garment(description))) longest = std::max(longest, tether.length);
  EXPECT_LT(longest, 0.5 * 2.0 * std::numbers::pi * 0.2 + 0.3) << "half around and down, from either side";
}

} // namespace
