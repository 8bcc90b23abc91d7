// The counter that judges stability runs must itself be beyond doubt.
#include "src/study/bench/crossings.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/mesh_sheet.h"

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
  return built(test::mesh_sheet(cells, {-0.3, 1.6, 0}, {0.6, 0, 0}, {0, -0.6, 0}, 0.3));
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

Vec3 on(const MovingPoint& point, double t) { return point.from + t * (point.to - point.from); }

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

TEST(Crossings, PassagesAgreeWithFineSampling) {
  // The twin: the sign of the volume at 20000 times, and the meeting of the segments where it changes.
  std::mt19937_64 random(5);
  int hits = 0, trials = 300;
  for (int trial = 0; trial < trials; ++trial) {
    MovingPoint points[4];
    for (MovingPoint& point : points) point = {test::random_point(random, 1.0), test::random_point(random, 1.0)};
    const auto& [p, q, a, b] = points;
    const auto volume = [&](double t) {
      return (on(q, t) - on(p, t)).dot((on(a, t) - on(p, t)).cross(on(b, t) - on(p, t)));
    };
    int net = 0;
    const int steps = 20000;
    for (int k = 0; k < steps; ++k) {
      const double t0 = static_cast<double>(k) / steps, t1 = static_cast<double>(k + 1) / steps;
      if ((volume(t0) <= 0.0) == (volume(t1) <= 0.0)) continue;
      // In the plane they share at this moment, seen along its normal, do they cross?
      const Vec3 P = on(p, t0), Q = on(q, t0), A = on(a, t0), B = on(b, t0);
      const Vec3 normal = (Q - P).cross(B - A);
      const auto side = [&](const Vec3& x, const Vec3& y, const Vec3& z) {
        return normal.dot((y - x).cross(z - x)) > 0.0;
      };
      if (side(P, Q, A) != side(P, Q, B) && side(A, B, P) != side(A, B, Q)) net += volume(t0) <= 0.0 ? 1 : -1;
    }
    hits += net != 0;
    EXPECT_EQ(net_passages(p, q, a, b), net) << "trial " << trial;
  }
  EXPECT_GT(hits, trials / 20);
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
  const cloth::Garment garment = built(test::mesh_sheet(6, {-0.3, 1.6, 0}, {0.6, 0, 0}, {0, -0.6, 0}));
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

TEST(Crossings, SurfacesThatGoThroughEachOtherAreCountedForAnyCloth) {
  for (const cloth::Garment& garment : {sheet(10), sheet_of_mesh(10)}) {
    const std::vector<Vec3>& rest = garment.rest_positions;
    const std::vector<Capsule> two = {{{0.01, 1.3, -0.2}, {0.02, 1.31, 0.2}, 0.03},
                                      {{0.2, 1.4, 0.01}, {0.2, 1.4, 0.01}, 0.04}};
    EXPECT_EQ(surfaces_through(garment, rest, two).colliders, 2) << "a sphere as well";
    EXPECT_EQ(surfaces_through(garment, rest, leg(1.31, 0.2)).colliders, 0);
    EXPECT_EQ(surfaces_through(garment, rest, two).cloth, 0);
    std::vector<Vec3> rolled = rest; // the lower half turns up and through the upper
    for (Vec3& p : rolled)
      if (p.y() < 1.3) p = Vec3(p.x(), 1.3 + 0.8 * (1.3 - p.y()), 0.1 - (1.3 - p.y()));
    EXPECT_EQ(surfaces_through(garment, rolled, {}).cloth, 1);
  }
  const cloth::Garment woven = sheet(10);
  std::vector<Vec3> folded = woven.rest_positions; // in two, its halves flush
  for (Vec3& p : folded) p.x() = std::abs(p.x());
  EXPECT_EQ(surfaces_through(woven, folded, {}).cloth, 0);
  cloth::TubeShape tube{20, 30, {{1.0, 0.2, 0.2}, {0.5, 0.3, 0.3}}, 0.0, 1.0};
  const cloth::Garment sewn = built(tube);
  ASSERT_FALSE(sewn.seams.empty());
  EXPECT_EQ(surfaces_through(sewn, sewn.rest_positions, {}).cloth, 0) << "a seam is no crossing";
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
