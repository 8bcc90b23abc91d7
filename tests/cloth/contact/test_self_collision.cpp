#include "cloth/contact/self_collision.h"
#include "cloth/metrics.h"
#include "cloth/state/tolerances.h"
#include "cloth/xpbd.h"
#include "tests/cloth/contact/two_layers.h"

#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <set>
#include <utility>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr double k_h = 1.0 / 600.0; // s, a substep

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
Vec3 random_vector(std::mt19937_64& random, double most) {
  return {uniform(random, -most, most), uniform(random, -most, most), uniform(random, -most, most)};
}

TEST(SpatialHash, FindsEveryPairInReachOnce) {
  std::mt19937_64 random(1);
  SpatialHash hash;
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Vec3> points;
    const double size = trial % 2 ? 0.5 : 30.0, reach = uniform(random, 0.02, 0.2);
    for (int i = 0; i < 400; ++i) points.push_back(random_vector(random, size));
    for (int i = 0; i < 100; ++i) points.push_back(points[i] + random_vector(random, reach));
    hash.build(points, reach);
    std::set<std::pair<int, int>> found;
    hash.for_each_pair([&](int i, int j, double squared) {
      EXPECT_EQ(squared, (points[j] - points[i]).squaredNorm());
      EXPECT_TRUE(found.insert(std::minmax({i, j})).second) << "twice";
    });
    EXPECT_LT(found.size(), points.size() * points.size() / 4);
    for (int i = 0; i < static_cast<int>(points.size()); ++i)
      for (int j = i + 1; j < static_cast<int>(points.size()); ++j)
        ASSERT_TRUE((points[j] - points[i]).cwiseAbs().maxCoeff() > reach || found.count({i, j})) << i << " " << j;
  }
}

TEST(SpatialHash, TakesAnyExtent) {
  SpatialHash hash;
  const std::vector<Vec3> points = {{-1e6, 1e6, 0}, {1e6, -1e6, 3}, {1e6, -1e6, 3 + 1e-4}};
  hash.build(points, 1e-3);
  int found = 0;
  hash.for_each_pair([&](int i, int j, double) { found += i + j == 3 ? 1 : 0; });
  EXPECT_EQ(found, 1);
  hash.build({}, 1.0);
  hash.for_each_pair([&](int, int, double) { ++found; });
  EXPECT_EQ(found, 1);
}

TEST(SelfCollision, CoveringRadiusLeavesNoHole) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 a = random_vector(random, 1), b = random_vector(random, 1), c = random_vector(random, 1);
    const double radius = covering_radius(a, b, c);
    double farthest = 0.0; // of a fine net of points, from the nearest corner
    constexpr int k_net = 200;
    for (int u = 0; u <= k_net; ++u)
      for (int v = 0; u + v <= k_net; ++v) {
        const Vec3 p = a + (b - a) * (u / double(k_net)) + (c - a) * (v / double(k_net));
        farthest = std::max(farthest, std::min({(p - a).norm(), (p - b).norm(), (p - c).norm()}));
      }
    EXPECT_LE(farthest, radius + 1e-12);
    EXPECT_GT(farthest, radius - 2.0 * ((b - a).norm() + (c - a).norm()) / k_net);
  }
}

/// What SelfCollision promises, without any memory: all pairs, in order.
struct Twin {
  const Garment& garment;
  std::vector<double> kept;
  std::vector<std::uint8_t> pinned = pinned_flags(garment);
  std::int64_t contacts = 0, slowed = 0;

  double weight(int i) const { return pinned[i] ? 0.0 : 1.0 / garment.masses[i]; }

  void resolve(const std::vector<Vec3>& start, std::vector<Vec3>& x, double h) {
    const int n = static_cast<int>(x.size());
    Vec3 mean = Vec3::Zero(), held = Vec3::Zero();
    int free = 0;
    for (int i = 0; i < n; ++i) {
      (pinned[i] ? held : mean) += x[i] - start[i];
      free += pinned[i] ? 0 : 1;
    }
    mean /= std::max(free, 1);
    held /= std::max(n - free, 1);
    const double off = (held - mean).norm(), most_off = k_most_off * *std::min_element(kept.begin(), kept.end());
    if (off > most_off) held = mean + (most_off / off) * (held - mean);
    for (int i = 0; i < n; ++i) {
      const double way = (x[i] - start[i] - mean).norm(), most = k_farthest_way * kept[i];
      if (pinned[i] || !(way > most)) continue;
      x[i] = start[i] + mean + (most / way) * (x[i] - start[i] - mean);
      ++slowed;
    }
    const double safe = std::sqrt(k_held * k_held - (k_worn_cell / k_cover) * (k_worn_cell / k_cover));
    struct Both {
      int i, j;
      double kept, before;
    };
    std::vector<Both> pairs;
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j) {
        const double d = std::max(kept[i], kept[j]);
        if ((garment.rest_positions[j] - garment.rest_positions[i]).norm() < k_same_patch * d) continue;
        if (pinned[i] && pinned[j]) continue;
        pairs.push_back({i, j, d, (start[j] - start[i]).norm()});
      }
    std::vector<std::uint8_t> cut(n, 0);
    for (bool changed = true; changed;) {
      changed = false;
      for (const Both& p : pairs) {
        const double way = (x[p.j] - x[p.i] - (start[p.j] - start[p.i])).norm();
        if (!(way > safe * p.kept + k_travel_slack && p.before < p.kept + way)) continue;
        for (const int k : {p.i, p.j}) {
          const Vec3 own = x[k] - start[k] - held;
          const double most = 0.5 * safe * kept[k];
          if (pinned[k] || cut[k] || own.norm() <= most) continue;
          x[k] = start[k] + held + (most / own.norm()) * own;
          cut[k] = 1;
          changed = true;
          ++slowed;
        }
      }
    }
    std::vector<Both> near;
    for (const Both& p : pairs)
      if ((x[p.j] - x[p.i]).norm() < (1.0 + k_near) * p.kept) near.push_back(p);
    std::vector<std::uint8_t> touched(near.size(), 0);
    for (int pass = 0; pass < k_self_passes; ++pass)
      for (std::size_t k = 0; k < near.size(); ++k) {
        const Both& p = near[k];
        Vec3 &a = x[p.i], &b = x[p.j];
        const double distance = (b - a).norm(), reached = std::min(p.kept, p.before + k_push_out_speed * h);
        if (!(distance < reached)) continue;
        const Vec3 normal = (b - a) / distance;
        const double share = weight(p.i) / (weight(p.i) + weight(p.j)), push = reached - distance;
        a -= (share * push) * normal;
        b += ((1.0 - share) * push) * normal;
        const Vec3 slip = (b - start[p.j]) - (a - start[p.i]);
        const Vec3 along = slip - slip.dot(normal) * normal;
        const double length = along.norm(), most = k_cloth_friction * push;
        const Vec3 back = length > most ? Vec3((most / length) * along) : along;
        a += share * back;
        b -= (1.0 - share) * back;
        touched[k] = 1;
      }
    contacts += std::accumulate(touched.begin(), touched.end(), 0);
  }
};

/// Moves the same particles with and without memory and compares them after each substep, to the bit.
void expect_twins(const Garment& garment, std::vector<Vec3> x, double speed, double drift, double kick, int substeps,
                  std::mt19937_64& random, SelfCollisionCounts* sum) {
  SelfCollision self(garment);
  Twin twin{garment, {}};
  const int n = garment.particle_count();
  for (int i = 0; i < n; ++i) twin.kept.push_back(self.kept_by(i));
  std::vector<Vec3> v;
  const Vec3 all = random_vector(random, drift);
  for (int i = 0; i < n; ++i) v.push_back(all + random_vector(random, speed));
  for (int substep = 0; substep < substeps; ++substep) {
    const std::vector<Vec3> start = x;
    for (int i = 0; i < n; ++i) {
      v[i] += random_vector(random, kick) - 0.002 * (start[i] - all * (substep * k_h)) / k_h * 0.05; // a weak pull back
      x[i] += k_h * v[i];
    }
    std::vector<Vec3> plain = x;
    ASSERT_TRUE(self.resolve(start, x, k_h));
    twin.resolve(start, plain, k_h);
    for (int i = 0; i < n; ++i) ASSERT_EQ(x[i], plain[i]) << "substep " << substep << " particle " << i;
    for (int i = 0; i < n; ++i) {
      x[i] += random_vector(random, 0.0002); // what a body does after it
      v[i] = (x[i] - start[i]) / k_h;
    }
  }
  EXPECT_EQ(self.counts().contacts, twin.contacts);
  EXPECT_EQ(self.counts().slowed, twin.slowed);
  sum->contacts += self.counts().contacts;
  sum->slowed += self.counts().slowed;
  sum->tests += self.counts().tests;
  sum->searches += self.counts().searches;
  sum->substeps += self.counts().substeps;
}

TEST(SelfCollision, IsThatOfAllPairsToTheBit) {
  std::mt19937_64 random(3);
  SelfCollisionCounts counts;
  double all_pairs = 0.0;
  for (int trial = 0; trial < 12; ++trial) { // clouds whose particles have sizes of their own, some of them pinned
    Garment garment;
    garment.fabric.thickness = 0.02;
    const int n = 150;
    std::vector<Vec3> x;
    for (int i = 0; i < n; ++i) {
      garment.rest_positions.push_back(random_vector(random, 1.0));
      garment.masses.push_back(uniform(random, 0.001, 0.003));
      x.push_back(random_vector(random, 0.12));
      if (i % 20 == 7) garment.pins.push_back({i, 0});
    }
    for (std::uint32_t i = 0; i < 30; i += 3) { // small triangles, elsewhere at rest than the others
      garment.rest_positions[i + 1] = garment.rest_positions[i] + random_vector(random, 0.03);
      garment.rest_positions[i + 2] = garment.rest_positions[i] + random_vector(random, 0.03);
      garment.triangles.push_back({i, i + 1, i + 2});
    }
    const double speeds[] = {0.05, 0.5, 3.0, 20.0};
    expect_twins(garment, x, speeds[trial % 4], trial % 3 == 0 ? 5.0 : 0.0, 0.05, 60, random, &counts);
    all_pairs += 60.0 * n * (n - 1) / 2;
  }
  EXPECT_GT(counts.contacts, 2000);
  EXPECT_GT(counts.slowed, 300);
  EXPECT_LT(counts.tests, all_pairs / 4);

  counts = {};
  for (int trial = 0; trial < 8; ++trial) { // folded sheets, nearly flat on themselves
    std::vector<Vec3> x;
    const Garment garment = test::folded_sheet(16, 0.3, 170.0 + trial, {}, x);
    expect_twins(garment, x, 0.1 + 0.4 * (trial % 4), trial % 2 ? 4.0 : 0.0, 0.02, 80, random, &counts);
  }
  EXPECT_GT(counts.contacts, 5000);
  EXPECT_LT(counts.searches, counts.substeps);
}

TEST(SelfCollision, KeepsMomentumAndParts) {
  std::mt19937_64 random(4);
  std::vector<Vec3> x;
  const Garment garment = test::folded_sheet(12, 0.3, 178.0, {}, x);
  const auto momentum = [&](const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) sum += garment.masses[i] * (to[i] - from[i]);
    return sum;
  };
  SelfCollision self(garment);
  const auto nearest = [&] { // over what it keeps
    double least = 10.0;
    for (int i = 0; i < garment.particle_count(); ++i)
      for (int j = 0; j < i; ++j) {
        const double kept = std::max(self.kept_by(i), self.kept_by(j));
        if ((garment.rest_positions[j] - garment.rest_positions[i]).norm() >= k_same_patch * kept)
          least = std::min(least, (x[j] - x[i]).norm() / kept);
      }
    return least;
  };
  EXPECT_LT(nearest(), 0.3); // a start in itself
  for (int substep = 0; substep < 60; ++substep) {
    const std::vector<Vec3> start = x, before = x;
    ASSERT_TRUE(self.resolve(start, x, k_h));
    EXPECT_LT(momentum(before, x).norm(), 1e-15);
    for (std::size_t i = 0; i < x.size(); ++i) // parted slowly: no pair faster than this, a particle has a few
      EXPECT_LT((x[i] - start[i]).norm(), 8.0 * k_push_out_speed * k_h);
  }
  EXPECT_GT(nearest(), 0.97);
}

TEST(SelfCollision, RefusesWhatIsNoNumber) {
  std::vector<Vec3> x;
  const Garment garment = test::folded_sheet(6, 0.3, 90.0, {}, x);
  SelfCollision self(garment);
  const std::vector<Vec3> start = x;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e12}) {
    std::vector<Vec3> broken = x;
    broken[5].y() = bad;
    EXPECT_FALSE(self.resolve(start, broken, k_h));
    EXPECT_FALSE(self.resolve(broken, x, k_h));
  }
  EXPECT_TRUE(self.resolve(start, x, k_h));
}

/// Times at which a particle goes through a triangle within a substep, all on straight ways: sign changes of the volume
/// at 16 steps, narrowed down, where the particle is within the triangle.
int passages(const Vec3 (&p)[2], const Vec3 (&a)[2], const Vec3 (&b)[2], const Vec3 (&c)[2]) {
  const auto at = [](const Vec3(&way)[2], double t) -> Vec3 { return (1.0 - t) * way[0] + t * way[1]; };
  const auto volume = [&](double t) {
    const Vec3 o = at(a, t);
    return (at(b, t) - o).cross(at(c, t) - o).dot(at(p, t) - o);
  };
  int count = 0;
  double before = volume(0.0);
  for (int step = 1; step <= 16; ++step) {
    double from = (step - 1) / 16.0, to = step / 16.0;
    const double now = volume(to);
    if ((before < 0.0) != (now < 0.0)) {
      for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (from + to);
        ((volume(middle) < 0.0) == (before < 0.0) ? from : to) = middle;
      }
      const Vec3 q = at(p, from), x = at(a, from), y = at(b, from), z = at(c, from), normal = (y - x).cross(z - x);
      const bool within = (y - x).cross(q - x).dot(normal) >= 0.0 && (z - y).cross(q - y).dot(normal) >= 0.0 &&
                          (x - z).cross(q - z).dot(normal) >= 0.0;
      count += within ? 1 : 0;
    }
    before = now;
  }
  return count;
}

/// Of all particles through all triangles they are no corner of.
int passages(const Garment& garment, const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  int count = 0;
  for (const auto& t : garment.triangles) {
    Vec3 low = from[t[0]], high = low;
    for (const std::uint32_t corner : t)
      for (const Vec3* end : {&from[corner], &to[corner]}) {
        low = low.cwiseMin(*end);
        high = high.cwiseMax(*end);
      }
    for (std::uint32_t i = 0; i < from.size(); ++i) {
      if ((from[i].array() < low.array() && to[i].array() < low.array()).any()) continue;
      if ((from[i].array() > high.array() && to[i].array() > high.array()).any()) continue;
      if (i == t[0] || i == t[1] || i == t[2]) continue;
      count += passages({from[i], to[i]}, {from[t[0]], to[t[0]]}, {from[t[1]], to[t[1]]}, {from[t[2]], to[t[2]]});
    }
  }
  return count;
}

TEST(SelfCollision, NothingPassesWithinTheSafeWay) {
  // A cell's triangle of legs 1, stretched to the bound, and a particle that goes through the middle of its longest
  // side, square to it; then any way, among others through the triangle.
  const double kept = k_cover * std::sqrt(0.5), held = k_held * kept, leg = k_worn_cell;
  const Vec3 a(0, 0, 0), b(leg, 0, 0), c(0, 0, leg), middle = 0.5 * (b + c) - Vec3(1e-9, 0, 1e-9);
  const double half = std::sqrt(held * held - 0.5 * leg * leg);
  EXPECT_NEAR(2.0 * half, safe_way(kept), 1e-12);
  const auto way_through = [&](double from) -> int {
    const Vec3 above = middle + Vec3(0, from, 0), below = middle - Vec3(0, from, 0);
    return passages({above, below}, {a, a}, {b, b}, {c, c});
  };
  EXPECT_EQ(way_through(half * 1.0001), 1); // both ends are held, and it passes: the bound is sharp

  std::mt19937_64 random(5);
  int held_ways = 0, farther_ways = 0, passed_farther = 0;
  for (int trial = 0; trial < 400000; ++trial) {
    Vec3 from[4] = {{}, a, b, c}, to[4]; // the particle and the corners
    const double u = uniform(random, 0.0, 1.0), v = uniform(random, 0.0, 1.0) * (1.0 - u);
    const Vec3 over = a + u * (b - a) + v * (c - a);
    from[0] = over + Vec3(uniform(random, -0.1, 0.1), uniform(random, 0.3, 0.9), uniform(random, -0.1, 0.1));
    to[0] = over + Vec3(uniform(random, -0.1, 0.1), uniform(random, -0.9, 0.5), uniform(random, -0.1, 0.1));
    if (trial % 2) to[0] = from[0] + 0.55 * random_vector(random, safe_way(kept));
    const Vec3 common = random_vector(random, 1.0);
    for (int k = 1; k < 4; ++k) {
      from[k] = middle + uniform(random, 0.9, 1.0) * (from[k] - middle);
      to[k] = from[k] + random_vector(random, 0.05);
    }
    for (Vec3& end : to) end += common; // which is of no account
    bool is_held = true, is_safe = true;
    for (int k = 1; k < 4; ++k) {
      is_held = is_held && (from[0] - from[k]).norm() >= held && (to[0] - to[k]).norm() >= held;
      is_safe = is_safe && (to[0] - to[k] - from[0] + from[k]).norm() < safe_way(kept);
    }
    for (const auto& corners : {from, to}) // the triangle is no larger than cloth may be stretched
      is_held = is_held && covering_radius(corners[1], corners[2], corners[3]) <= leg * std::sqrt(0.5);
    if (!is_held) continue;
    const int passed = passages({from[0], to[0]}, {from[1], to[1]}, {from[2], to[2]}, {from[3], to[3]});
    ++(is_safe ? held_ways : farther_ways);
    if (is_safe) ASSERT_EQ(passed, 0) << "trial " << trial;
    else passed_farther += passed;
  }
  EXPECT_GT(held_ways, 1000);
  EXPECT_GT(passed_farther, farther_ways / 5);
}

struct Fall {
  int passed = 0;
  double least_gap = 1.0; ///< m at the end, of a particle of the upper sheet over the highest of the lower near it
  double fastest = 0.0;   ///< m/s at the end
  SelfCollisionCounts counts = {};
};

/// The upper of two sheets is thrown down on the lower, which lies on the ground.
Fall fall(double speed, double shift, bool keep_apart, int substeps) {
  constexpr int n = 14;
  Fabric fabric;
  fabric.drag = 0.2;
  const Garment garment = test::two_sheets(n, 0.3, 0.12, shift, fabric);
  SolverOptions options;
  options.self_collision = keep_apart;
  const auto solver = make_xpbd(garment, options);
  Particles state{garment.rest_positions, std::vector<Vec3>(garment.rest_positions.size(), Vec3::Zero())};
  for (int i = 0; i < garment.particle_count(); ++i) {
    state.positions[i].y() += fabric.contact_offset();
    if (i % (2 * n) >= n) state.velocities[i] = Vec3(0.1 * speed, -speed, 0.0);
  }
  solver->restore(state);
  const auto query = proxies::make_query(proxies::Backend::brute);
  const std::vector<double> friction = {0.3};
  FrameInput input;
  input.colliders.ground = proxies::Plane{};
  input.friction = friction;
  input.seconds = k_h; // a frame is one substep, so that the test sees each
  input.substeps = 1;
  Fall result;
  std::vector<Vec3> before = state.positions;
  for (int k = 0; k < substeps; ++k) {
    EXPECT_FALSE(solver->step(input, *query).has_value());
    const std::vector<Vec3>& now = solver->particles().positions;
    result.passed += passages(garment, before, now);
    before = now;
  }
  result.counts = solver->self_collision_counts();
  const double cell = 0.3 / (n - 1);
  for (int i = 0; i < garment.particle_count(); ++i) {
    result.fastest = std::max(result.fastest, solver->particles().velocities[i].norm());
    if (i % (2 * n) < n) continue;
    double highest = -1.0;
    for (int j = 0; j < garment.particle_count(); ++j) {
      const Vec3 d = before[i] - before[j];
      if (j % (2 * n) < n && std::hypot(d.x(), d.z()) < 0.75 * cell) highest = std::max(highest, before[j].y());
    }
    if (highest >= 0.0) result.least_gap = std::min(result.least_gap, before[i].y() - highest);
  }
  return result;
}

TEST(SelfCollision, AFallingSheetComesToRestOnAnother_slow) {
  const double cell = 0.3 / 13;
  for (const double shift : {0.0, 0.37, 0.5})
    for (const double speed : {0.0, 1.0, 3.0, 10.0, 30.0}) {
      const Fall kept = fall(speed, shift, true, 600);
      EXPECT_EQ(kept.passed, 0) << speed << " m/s, shift " << shift;
      EXPECT_GT(kept.least_gap, 0.3 * cell) << speed << " m/s, shift " << shift;
      EXPECT_LT(kept.fastest, 0.5) << speed << " m/s, shift " << shift;
    }
  EXPECT_GT(fall(3.0, 0.37, false, 120).passed, 100); // what it would be without
}

TEST(SelfCollision, AFoldedSheetLiesOnItself_slow) {
  constexpr int n = 24;
  std::vector<Vec3> start;
  Fabric fabric;
  const Garment garment = test::folded_sheet(n, 0.4, 150.0, fabric, start);
  for (Vec3& p : start) p.y() += fabric.contact_offset();
  SolverOptions options;
  options.self_collision = true;
  const auto solver = make_xpbd(garment, options);
  solver->reset(start);
  const auto query = proxies::make_query(proxies::Backend::hybrid);
  const std::vector<double> friction = {0.5};
  FrameInput input;
  input.colliders.ground = proxies::Plane{};
  input.friction = friction;
  input.substeps = 1;
  input.seconds = k_h;
  int passed = 0;
  std::vector<Vec3> before = start;
  for (int k = 0; k < 1200; ++k) {
    ASSERT_FALSE(solver->step(input, *query).has_value());
    const std::vector<Vec3>& now = solver->particles().positions;
    if (k % 2) {
      passed += passages(garment, before, now);
      before = now;
    }
  }
  EXPECT_EQ(passed, 0);
  const SelfCollision self(garment);
  double nearest = 10.0;
  for (int i = 0; i < garment.particle_count(); ++i)
    for (int j = 0; j < i; ++j) {
      const double kept = std::max(self.kept_by(i), self.kept_by(j));
      if ((garment.rest_positions[j] - garment.rest_positions[i]).norm() >= k_same_patch * kept)
        nearest = std::min(nearest, (before[j] - before[i]).norm() / kept);
    }
  EXPECT_GT(nearest, k_held);
  for (int row = n / 2 + 4; row < n - 1; ++row) // the upper layer lies on the lower, not beside it
    for (int column = 0; column < n; ++column) {
      EXPECT_GT(before[row * n + column].y(), fabric.contact_offset() + 0.3 * 0.4 / (n - 1));
      EXPECT_LT(before[row * n + column].y(), 0.06);
    }
}

TEST(SelfCollision, ClothThatMeetsNothingIsAsWithout) {
  GarmentDescription description;
  description.file = "sheet";
  description.shape = GridShape{12, 12, {-0.25, 1, 0}, {0.5, 0, 0}, {0, 0, 0.5}};
  description.attachments = {{"Hips", 0, 0, 0, -1}};
  const Garment garment = build_garment(description);
  EXPECT_FALSE(SolverOptions{}.self_collision);
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  for (const bool precise : {false, true}) {
    std::uint64_t hashes[2] = {};
    for (const bool on : {false, true}) {
      SolverOptions options;
      options.self_collision = on;
      options.double_precision = precise;
      const auto solver = make_xpbd(garment, options);
      const auto query = proxies::make_query(proxies::Backend::hybrid);
      FrameInput input;
      input.substeps = 8;
      input.pins_start = input.pins_end = pins;
      for (int f = 0; f < 30; ++f) ASSERT_FALSE(solver->step(input, *query).has_value());
      hashes[on] = state_hash(solver->particles());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
  }
}

TEST(SelfCollision, RunsAreRepeatable) {
  std::vector<Vec3> start;
  const Garment garment = test::folded_sheet(16, 0.3, 160.0, {}, start);
  std::uint64_t hashes[2] = {};
  for (std::uint64_t& hash : hashes) {
    SolverOptions options;
    options.self_collision = true;
    const auto solver = make_xpbd(garment, options);
    if (&hash == &hashes[1]) { // a past that is forgotten
      FrameInput input;
      input.substeps = 3;
      const auto query = proxies::make_query(proxies::Backend::hybrid);
      ASSERT_FALSE(solver->step(input, *query).has_value());
    }
    solver->reset(start);
    const auto query = proxies::make_query(proxies::Backend::hybrid);
    FrameInput input;
    input.substeps = 10;
    input.colliders.ground = proxies::Plane{};
    for (int f = 0; f < 40; ++f) ASSERT_FALSE(solver->step(input, *query).has_value());
    hash = state_hash(solver->particles());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

} // namespace
