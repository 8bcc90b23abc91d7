// Geometry that drawing makes for itself, and the averaging of large pictures into small ones.
#include "src/view/render/capsule_mesh.h"
#include "src/view/render/closed_skin.h"
#include "src/view/render/offscreen.h"

#include <gtest/gtest.h>
#include <map>

namespace tutu::app {
namespace {

using Edges = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;

Edges directed_edges(const std::vector<rig::Triangle>& triangles) {
  Edges edges;
  for (const rig::Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  return edges;
}

/// Every edge once in each direction: closed, and turned the same way everywhere.
void expect_closed(const std::vector<rig::Triangle>& triangles) {
  const Edges edges = directed_edges(triangles);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
}

TEST(ClosedSkin, OfASheetIsClosed) {
  std::vector<rig::Triangle> sheet;
  const std::uint32_t side = 5;
  for (std::uint32_t y = 0; y + 1 < side; ++y)
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const std::uint32_t a = y * side + x;
      sheet.push_back({a, a + 1, a + side});
      sheet.push_back({a + 1, a + side + 1, a + side});
    }
  const auto skin = closed_skin(sheet, side * side);
  EXPECT_EQ(skin.size(), 2 * sheet.size() + 2 * 4 * (side - 1));
  expect_closed(skin);
}

TEST(ClosedSkin, OfATubeHasTwoRims) {
  std::vector<rig::Triangle> tube;
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    tube.push_back({i, j, i + 6});
    tube.push_back({j, j + 6, i + 6});
  }
  const auto skin = closed_skin(tube, 12);
  EXPECT_EQ(skin.size(), 2 * tube.size() + 2 * 12);
  expect_closed(skin);
}

TEST(CapsuleMesh, IsClosedRoundAndFacesOutwards) {
  const CapsuleMesh mesh = capsule_mesh(16, 5);
  for (const Eigen::Vector4f& v : mesh.vertices) {
    EXPECT_NEAR(v.head<3>().norm(), 1, 1e-6);
    EXPECT_EQ(v.w(), v.y() > 1e-6f ? 1 : v.y() < -1e-6f ? 0 : v.w());
  }
  // A capsule 1 m long of radius 0.5 m; its volume by the divergence theorem, a little less than the round one's.
  double volume = 0;
  const auto corner = [&](std::uint32_t i) {
    const Eigen::Vector4f v = mesh.vertices[i];
    return Vec3f(0.5f * v.head<3>() + Vec3f(0, v.w(), 0));
  };
  for (const rig::Triangle& t : mesh.triangles) volume += corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6;
  const double pi = 3.14159265358979, round = 4.0 / 3 * pi * 0.125 + pi * 0.25;
  EXPECT_LT(volume, round);
  EXPECT_GT(volume, 0.95 * round);
}

TEST(Reduce, TurnsRowsRoundAndDropsAlpha) {
  Image image{.width = 2, .height = 2, .pixels = {}};
  reduce({1, 2, 3, 9, 4, 5, 6, 9, /* upper row */ 7, 8, 9, 9, 10, 11, 12, 9}, 1, image);
  EXPECT_EQ(image.pixels, (std::vector<std::uint8_t>{7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6}));
}

TEST(Reduce, KeepsPlainColoursAndAveragesLight) {
  for (int value = 0; value < 256; ++value) {
    const auto byte = static_cast<std::uint8_t>(value);
    Image image{.width = 1, .height = 1, .pixels = {}};
    reduce(std::vector<std::uint8_t>(16, byte), 2, image);
    EXPECT_NEAR(image.pixels[0], value, value < 12 ? 1 : 0) << value;
  }
  Image image{.width = 1, .height = 1, .pixels = {}};
  reduce({255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 255}, 2, image);
  EXPECT_NEAR(image.pixels[0], 188, 1); // half the light of white
}

} // namespace
} // namespace tutu::app
