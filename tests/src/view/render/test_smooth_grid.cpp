// The fine sheet through a coarse grid.
#include "src/view/render/smooth_grid.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tutu::app {
namespace {

constexpr float k_pi = 3.14159265f;

std::vector<Vec3f> tube(int rows, int columns) {
  std::vector<Vec3f> particles;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const float angle = 2 * k_pi * static_cast<float>(c) / static_cast<float>(columns);
      particles.emplace_back(std::sin(angle), -0.2f * static_cast<float>(r), std::cos(angle));
    }
  return particles;
}

TEST(SmoothGrid, GoesThroughTheParticles) {
  const auto particles = tube(5, 12);
  SmoothGrid grid({.rows = 5, .columns = 12, .closed = true}, 3);
  grid.update(particles);
  ASSERT_EQ(grid.positions().size(), 13u * 36u);
  for (std::size_t r = 0; r < 5; ++r)
    for (std::size_t c = 0; c < 12; ++c) EXPECT_EQ(grid.positions()[3 * r * 36 + 3 * c], particles[r * 12 + c]);
}

TEST(SmoothGrid, ARoundTubeIsRounderThanItsPolygon) {
  SmoothGrid grid({.rows = 4, .columns = 12, .closed = true}, 4);
  grid.update(tube(4, 12));
  const float polygon = 1 - std::cos(k_pi / 12); // how far the middle of a straight cell lies inside
  for (const Vec3f& p : grid.positions()) EXPECT_LT(std::abs(std::hypot(p.x(), p.z()) - 1), 0.15f * polygon);
}

TEST(SmoothGrid, NormalsAreUnitAndAgreeWithTheTriangles) {
  for (const bool flipped : {false, true}) {
    SmoothGrid grid({.rows = 4, .columns = 10, .closed = true}, 3, flipped);
    grid.update(tube(4, 10));
    for (const Vec3f& n : grid.normals()) EXPECT_NEAR(n.norm(), 1, 1e-5);
    for (const rig::Triangle& t : grid.triangles()) {
      const auto& p = grid.positions();
      const Vec3f face = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
      for (const std::uint32_t i : t) EXPECT_GT(face.dot(grid.normals()[i]), 0.9f);
    }
  }
}

TEST(SmoothGrid, AFlatSheetStaysFlatAndKeepsItsEdges) {
  std::vector<Vec3f> particles;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) particles.emplace_back(static_cast<float>(c), 0.0f, static_cast<float>(r));
  SmoothGrid grid({.rows = 3, .columns = 4}, 5);
  grid.update(particles);
  EXPECT_EQ(grid.triangles().size(), 2u * 15 * 10);
  for (const Vec3f& p : grid.positions()) {
    EXPECT_NEAR(p.y(), 0, 1e-6);
    EXPECT_GE(p.x(), -1e-5f);
    EXPECT_LE(p.x(), 3 + 1e-5f);
  }
}

TEST(SmoothGrid, FactorOneIsTheGridItselfAndNonsenseIsRefused) {
  const auto particles = tube(3, 5);
  SmoothGrid grid({.rows = 3, .columns = 5, .closed = true}, 1);
  grid.update(particles);
  EXPECT_EQ(grid.positions(), particles);
  EXPECT_THROW(grid.update(std::span(particles).first(7)), std::invalid_argument);
  EXPECT_THROW(SmoothGrid({.rows = 1, .columns = 5}, 2), std::invalid_argument);
  EXPECT_THROW(SmoothGrid({.rows = 2, .columns = 2, .closed = true}, 2), std::invalid_argument);
  EXPECT_THROW(SmoothGrid({.rows = 2, .columns = 2}, 0), std::invalid_argument);
}

} // namespace
} // namespace tutu::app
