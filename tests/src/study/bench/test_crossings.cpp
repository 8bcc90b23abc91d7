// The counter that judges stability runs must itself be beyond doubt.
#include "src/study/bench/crossings.h"
#include "tests/support/collider_scenes.h"

#include <gtest/gtest.h>

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

} // namespace
