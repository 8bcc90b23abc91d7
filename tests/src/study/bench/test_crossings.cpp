// The counter that judges stability runs must itself be beyond doubt.
#include "src/study/bench/crossings.h"
#include "src/study/bench/mesh_sheet.h"

#include <gtest/gtest.h>
#include <map>
#include <set>

using namespace tutu;
using namespace tutu::app;
using proxies::Capsule;

namespace {

cloth::Garment sheet(int n) {
  cloth::GarmentDescription description;
  description.file = "sheet";
  description.shape = cloth::GridShape{n, n, {-0.3, 1.6, 0}, {0.6, 0, 0}, {0, -0.6, 0}};
  return cloth::build_garment(description);
}

cloth::Garment
built(const std::variant<cloth::GridShape, cloth::TubeShape, cloth::DiscShape, cloth::MeshShape>& shape) {
  cloth::GarmentDescription description;
  description.file = "shape";
  description.shape = shape;
  return cloth::build_garment(description);
}

/// The same sheet of other triangles.
cloth::Garment sheet_of_mesh(int cells) {
  return built(app::mesh_sheet(cells, {-0.3, 1.6, 0}, {0.6, 0, 0}, {0, -0.6, 0}, 0.3));
}

/// How many threads reach from the upper border to the hem.
int upright(const cloth::Garment& garment) {
  int count = 0;
  for (const Thread& thread : threads_of(garment))
    count += std::abs(place_of(thread.front(), garment.rest_positions).y() -
                      place_of(thread.back(), garment.rest_positions).y()) > 0.599;
  return count;
}

/// Lies along x, not quite.
std::vector<Capsule> leg(double y, double z) { return {{{-0.5, y + 0.003, z}, {0.5, y, z + 0.004}, 0.06}}; }

TEST(Crossings, ALegThatTunnelsIsSeenThoughItIsClearBeforeAndAfter) {
  const cloth::Garment garment = sheet(10);
  CrossingCounter counter(garment);
  counter.start(garment.rest_positions, leg(1.31, -0.2));
  counter.advance(garment.rest_positions, leg(1.31, 0.3));
  EXPECT_EQ(counter.crossings(), 10) << "each warp thread";
  EXPECT_EQ(counter.pierced(), 0);
}

TEST(Crossings, ALegThatPushesTheClothAlongDoesNotCross) {
  const cloth::Garment garment = sheet(10);
  CrossingCounter counter(garment);
  counter.start(garment.rest_positions, leg(1.31, -0.2));
  std::vector<Vec3> pushed = garment.rest_positions;
  for (Vec3& p : pushed) p.z() += 0.4;
  counter.advance(pushed, leg(1.31, 0.3));
  EXPECT_EQ(counter.crossings(), 0);
}

TEST(Crossings, ClothMaySlipOffAroundItsEdge) {
  const cloth::Garment garment = sheet(10);
  CrossingCounter counter(garment);
  counter.start(garment.rest_positions, leg(0.95, -0.2)); // below the hem
  counter.advance(garment.rest_positions, leg(0.95, 0.3));
  EXPECT_EQ(counter.crossings(), 0);
}

TEST(Crossings, ALegThatIsStuckIsSeenAtTheFramesEnd) {
  const cloth::Garment garment = sheet(10);
  CrossingCounter counter(garment);
  counter.start(garment.rest_positions, leg(1.31, -0.2));
  const std::vector<Capsule> stuck = {{{0.01, 1.31, -0.2}, {0.02, 1.3, 0.2}, 0.06}};
  counter.advance(garment.rest_positions, stuck);
  EXPECT_EQ(counter.pierced_now(), 1);
  counter.advance(garment.rest_positions, leg(1.31, -0.2));
  EXPECT_EQ(counter.pierced_now(), 0);
  EXPECT_EQ(counter.pierced(), 1);
}

TEST(Crossings, ABagThatOpensToTheWrongSideIsACrossing) {
  const cloth::Garment garment = sheet(10);
  CrossingCounter counter(garment);
  counter.start(garment.rest_positions, leg(1.31, -0.05));
  std::vector<Vec3> bulged = garment.rest_positions;
  for (Vec3& p : bulged)
    if (std::abs(p.y() - 1.31) < 0.1) p.z() -= 0.3; // the middle goes behind the axis, the ends stay before it
  counter.advance(bulged, leg(1.31, -0.05));
  EXPECT_EQ(counter.crossings(), 10) << "now the axis is in a bag that opened to the wrong side";
  counter.advance(garment.rest_positions, leg(1.31, -0.05));
  EXPECT_EQ(counter.crossings(), 20) << "and out again";
}

TEST(Crossings, ALegThatMeetsParticlesHeadOnCrossesEachThreadOnce) {
  const cloth::Garment garment = sheet(10);
  for (const int row : {1, 4, 8}) {
    const double y = garment.rest_positions[row * 10].y();
    const auto level = [&](double z) { return std::vector<Capsule>{{{-0.5, y, z}, {0.5, y, z}, 0.06}}; };
    CrossingCounter counter(garment);
    counter.start(garment.rest_positions, level(-0.2));
    counter.advance(garment.rest_positions, level(0.2));
    EXPECT_EQ(counter.crossings(), 10) << "row " << row;
  }
}

TEST(Crossings, ALegThatClothLiesOnIsCarriedAlongWithoutACrossing) {
  // Ten metres in a frame, exactly; the cloth hangs over the leg, touching its axis all along.
  for (const cloth::Garment& garment : {sheet(9), sheet_of_mesh(9)}) {
    const std::vector<Capsule> before = {{{-0.5, 1.3, 0}, {0.5, 1.3, 0}, 0.06}};
    std::vector<Capsule> after = before;
    after[0].a += Vec3(8, 0, 2);
    after[0].b += Vec3(8, 0, 2);
    std::vector<Vec3> hung = garment.rest_positions, carried;
    for (Vec3& p : hung) { // to multiples of 2^-20, so that sums are exact
      if (p.y() < 1.3) p = Vec3(p.x(), 1.3, 1.3 - p.y());
      for (double& x : p) x = std::round(x * 0x1p20) * 0x1p-20;
    }
    for (const Vec3& p : hung) carried.push_back(p + Vec3(8, 0, 2));
    CrossingCounter counter(garment);
    counter.start(hung, before);
    counter.advance(carried, after);
    EXPECT_EQ(counter.crossings(), 0);
  }
}

TEST(Crossings, AMeshIsWatchedAsWovenClothIs) {
  for (const int cells : {2, 5, 10, 30}) {
    const cloth::Garment garment = sheet_of_mesh(cells);
    const int across = upright(garment);
    EXPECT_GE(across, cells - 1 - cells / 10) << "lines as dense as edges";
    EXPECT_LE(across, cells + 1);
    CrossingCounter counter(garment);
    counter.start(garment.rest_positions, leg(1.3137, -0.2));
    counter.advance(garment.rest_positions, leg(1.3137, 0.3));
    EXPECT_EQ(counter.crossings(), across) << "through";
    EXPECT_EQ(counter.pierced(), 0);

    std::vector<Vec3> pushed = garment.rest_positions, bulged = pushed;
    for (Vec3& p : pushed) p.z() += 0.4;
    counter.start(garment.rest_positions, leg(1.3137, -0.2));
    counter.advance(pushed, leg(1.3137, 0.3));
    EXPECT_EQ(counter.crossings(), 0) << "pushed along";

    counter.start(garment.rest_positions, leg(0.95, -0.2));
    counter.advance(garment.rest_positions, leg(0.95, 0.3));
    EXPECT_EQ(counter.crossings(), 0) << "below the hem";

    if (cells < 10) continue;
    for (Vec3& p : bulged)
      if (std::abs(p.y() - 1.3137) < 0.1) p.z() -= 0.3;
    counter.start(garment.rest_positions, leg(1.3137, -0.05));
    counter.advance(bulged, leg(1.3137, -0.05));
    EXPECT_EQ(counter.crossings(), across) << "a bag that opens to the wrong side";
  }
}

TEST(Crossings, ALegStuckInAnEdgeOfAMeshIsInOneTriangle) {
  const cloth::Garment garment = built(app::mesh_sheet(6, {-0.3, 1.6, 0}, {0.6, 0, 0}, {0, -0.6, 0}));
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : garment.triangles)
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  int inner = 0;
  for (const auto& [i, j] : edges) {
    const Vec3 middle = 0.5 * (garment.rest_positions[i] + garment.rest_positions[j]);
    if (std::abs(middle.x()) > 0.29 || middle.y() > 1.59 || middle.y() < 1.01) continue; // on the border
    ++inner;
    CrossingCounter counter(garment);
    const Vec3 along(0, 0, 0.2);
    counter.start(garment.rest_positions, leg(1.3, -0.2));
    counter.advance(garment.rest_positions, std::vector<Capsule>{{middle - along, middle + along, 0.01}});
    EXPECT_EQ(counter.pierced_now(), 1) << i << " " << j;
  }
  EXPECT_GT(inner, 50);
}

TEST(Crossings, WhatIsNoNumberIsNotCounted) {
  const cloth::Garment garment = sheet_of_mesh(6);
  CrossingCounter counter(garment);
  counter.start(garment.rest_positions, leg(1.31, -0.2));
  counter.advance(std::vector<Vec3>(garment.rest_positions.size(), Vec3::Constant(std::nan(""))), leg(1.31, 0.2));
  EXPECT_EQ(counter.crossings() + counter.pierced(), 0);
}

TEST(Threads, OfWovenClothAreItsRowsAndColumns) {
  const std::vector<Thread> threads = threads_of(sheet(10));
  ASSERT_EQ(threads.size(), 20u);
  for (const Thread& thread : threads) EXPECT_EQ(thread.size(), 10u);
}

TEST(Threads, OfAnyShapeEndOnlyAtTheBorder) {
  cloth::MeshShape tube; // a ring of triangles, open above and below, and with a hole
  const cloth::Garment woven = built(cloth::TubeShape{12, 25, {{1.0, 0.2, 0.2}, {0.5, 0.3, 0.25}}, 0.0, {}});
  tube.positions = woven.rest_positions;
  for (std::size_t t = 0; t < woven.triangles.size(); ++t)
    if (t < 150 || t > 154) tube.triangles.push_back(woven.triangles[t]);
  int closed = 0, open = 0;
  for (const cloth::Garment& garment :
       {built(tube), sheet_of_mesh(9), built(cloth::DiscShape{{0, 1, 0}, 0.3, 0.2, 6, 0.2})}) {
    std::map<std::pair<int, int>, int> triangles_at;
    for (const auto& t : garment.triangles)
      for (int k = 0; k < 3; ++k) ++triangles_at[std::minmax(static_cast<int>(t[k]), static_cast<int>(t[(k + 1) % 3]))];
    const auto on_border = [&](const ThreadPoint& p) { return triangles_at.at(std::minmax(p.i, p.j)) == 1; };
    for (const Thread& thread : threads_of(garment)) {
      ASSERT_GE(thread.size(), 2u);
      const ThreadPoint &first = thread.front(), &last = thread.back();
      const bool is_closed = first.i == last.i && first.j == last.j;
      closed += is_closed;
      open += !is_closed;
      for (const ThreadPoint& p : thread) EXPECT_TRUE(p.share >= 0.0 && p.share <= 1.0);
      if (is_closed) continue;
      EXPECT_TRUE(on_border(first) && on_border(last)) << garment.particle_count();
      for (std::size_t k = 1; k + 1 < thread.size(); ++k) EXPECT_FALSE(on_border(thread[k]));
    }
  }
  EXPECT_GT(closed, 5);
  EXPECT_GT(open, 20);
}

} // namespace
