// What is counted where surfaces go through each other, against every pair tried and by scenes whose count is plain.
#include "proxies/crossing/capsule_surface.h"
#include "proxies/crossing/segment_triangle.h"
#include "proxies/crossing/surface_crossings.h"
#include "proxies/distance/signed_distance.h"
#include "tests/support/collider_scenes.h"

#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <set>

using namespace tutu;
using namespace tutu::proxies;

namespace {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<rig::Triangle> triangles;
  CrossingSurface view() const { return {positions, triangles}; }
};

/// A level sheet of n x n cells, 1 m wide about (0, 0, z), with diagonals either way and inner corners off the grid.
Mesh sheet(int n, double z, double jitter, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  Mesh mesh;
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c) {
      const bool inner = r > 0 && r < n && c > 0 && c < n;
      const Vec3 shift = test::random_point(random, inner ? jitter / n : 0.0);
      mesh.positions.push_back(Vec3(static_cast<double>(c) / n - 0.5, static_cast<double>(r) / n - 0.5, z) + shift);
    }
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const auto i = static_cast<std::uint32_t>(r * (n + 1) + c), m = static_cast<std::uint32_t>(n + 1);
      if (random() % 2) {
        mesh.triangles.push_back({i, i + 1, i + m + 1});
        mesh.triangles.push_back({i, i + m + 1, i + m});
      } else {
        mesh.triangles.push_back({i, i + 1, i + m});
        mesh.triangles.push_back({i + 1, i + m + 1, i + m});
      }
    }
  return mesh;
}

Mesh solid(const Capsule& capsule, int around = 16) {
  const CapsuleTriangles surface = capsule_surface(capsule, around);
  return {surface.positions, surface.triangles};
}

/// The twin: every edge against every triangle, and linked by walking from pair to pair.
SurfaceCrossings tried_all(const Mesh& one, const Mesh& other, bool same) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  struct Pair {
    std::set<std::pair<int, int>> meetings;
  };
  std::vector<Pair> pairs;
  const auto collect = [&](const Mesh& a, const Mesh& b, Beside beside, bool swapped) {
    std::map<Edge, std::vector<int>> edges;
    for (std::size_t t = 0; t < a.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        edges[std::minmax(a.triangles[t][k], a.triangles[t][(k + 1) % 3])].push_back(static_cast<int>(t));
    for (const auto& [edge, owners] : edges)
      for (std::size_t t = 0; t < b.triangles.size(); ++t) {
        const rig::Triangle& c = b.triangles[t];
        if (same && std::any_of(c.begin(), c.end(), [&](auto v) { return v == edge.first || v == edge.second; }))
          continue;
        if (!passage_through(a.positions[edge.first], a.positions[edge.second], b.positions[c[0]], b.positions[c[1]],
                             b.positions[c[2]], beside))
          continue;
        Pair pair;
        for (const int s : owners) {
          const int i = static_cast<int>(t);
          if (same) pair.meetings.insert(std::minmax(s, i));
          else pair.meetings.insert(swapped ? std::pair(i, s) : std::pair(s, i));
        }
        pairs.push_back(pair);
      }
  };
  collect(one, other, Beside::behind, false);
  if (!same) collect(other, one, Beside::before, true);
  std::vector<bool> seen(pairs.size());
  SurfaceCrossings found{static_cast<int>(pairs.size()), 0, 0};
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (seen[k]) continue;
    ++found.crossings;
    std::vector<std::size_t> open = {k};
    seen[k] = true;
    while (!open.empty()) {
      const Pair& now = pairs[open.back()];
      open.pop_back();
      for (std::size_t m = 0; m < pairs.size(); ++m)
        if (!seen[m] && std::any_of(pairs[m].meetings.begin(), pairs[m].meetings.end(),
                                    [&](const auto& meeting) { return now.meetings.count(meeting) > 0; })) {
          seen[m] = true;
          open.push_back(m);
        }
    }
  }
  return found;
}

void expect_counts(const SurfaceCrossings& found, const SurfaceCrossings& expected, int trial) {
  EXPECT_EQ(found.pairs, expected.pairs) << "trial " << trial;
  EXPECT_EQ(found.crossings, expected.crossings) << "trial " << trial;
}

TEST(SurfaceCrossings, AgreeWithEveryPairTried) {
  std::mt19937_64 random(11);
  int meet = 0, several = 0;
  constexpr int k_trials = 60;
  for (int trial = 0; trial < k_trials; ++trial) {
    const Mesh cloth = sheet(9, 0.0, trial % 3 ? 1.2 : 0.0, trial); // some on a grid, some folded over themselves
    const Vec3 a = test::random_point(random, 0.6), b = test::random_point(random, 0.6);
    const Mesh body = solid({a, trial % 5 ? b : a, 0.08, trial % 2 && trial % 5 ? 0.06 : 0.0}, 9);
    const SurfaceCrossings found = crossings_between(cloth.view(), body.view());
    expect_counts(found, tried_all(cloth, body, false), trial);
    meet += found.crossings > 0;
    expect_counts(crossings_within(cloth.view()), tried_all(cloth, cloth, true), trial);
    several += crossings_within(cloth.view()).crossings > 1;
  }
  EXPECT_GT(meet, k_trials * 3 / 10);
  EXPECT_LT(meet, k_trials);
  EXPECT_GT(several, k_trials / 10);
}

TEST(SurfaceCrossings, TouchingAgreesWithEveryPairTried) {
  // All corners on a small grid: most of what meets touches.
  std::mt19937_64 random(12);
  for (int trial = 0; trial < 300; ++trial) {
    Mesh one, other;
    for (Mesh* mesh : {&one, &other}) {
      *mesh = sheet(2, 0.0, 0.0, random());
      for (Vec3& p : mesh->positions)
        p = Vec3(static_cast<double>(random() % 3), static_cast<double>(random() % 3),
                 static_cast<double>(random() % 3));
    }
    expect_counts(crossings_between(one.view(), other.view()), tried_all(one, other, false), trial);
  }
}

TEST(SurfaceCrossings, WhatHasMovedIsCountedAsIfItHadBegunThere) {
  std::mt19937_64 random(14);
  const Mesh rest = sheet(9, 0.0, 0.3);
  const Capsule limb{{-0.1, 0, 0}, {0.1, 0, 0}, 0.08};
  const Mesh body = solid(limb, 9);
  CrossingSurface cloth = rest.view(), solid_surface = body.view();
  int meet = 0;
  constexpr int k_trials = 60;
  for (int trial = 0; trial < k_trials; ++trial) {
    Mesh moved = rest, other = body;
    for (Vec3& p : moved.positions) p += test::random_point(random, 0.1);
    if (trial % 4 == 0) moved.positions[trial] = Vec3::Constant(std::nan("")); // for this once
    const Vec3 way = test::random_point(random, 0.5);
    for (Vec3& p : other.positions) p += way;
    cloth.move(moved.positions);
    solid_surface.move(other.positions);
    const SurfaceCrossings found = crossings_between(cloth, solid_surface);
    meet += found.crossings > 0;
    expect_counts(found, crossings_between(moved.view(), other.view()), trial);
    expect_counts(crossings_within(cloth), crossings_within(moved.view()), trial);
    if (trial % 4) expect_counts(found, tried_all(moved, other, false), trial);
  }
  EXPECT_GT(meet, k_trials * 3 / 10);
  EXPECT_LT(meet, k_trials);
}

TEST(SurfaceCrossings, WhatWasPlacedSoIsCountedApart) {
  // Two rods through a sheet whose half beyond x = 0 is placed; rods are placed as a whole.
  const Mesh cloth = sheet(8, 0.0, 0.0);
  std::vector<std::uint8_t> half;
  for (const Vec3& p : cloth.positions) half.push_back(p.x() > -1e-9);
  const auto through = [&](std::initializer_list<double> at) {
    SurfaceCrossings found;
    for (const double x : at) {
      const Mesh rod = solid({{x, 0.03, -0.4}, {x, 0.03, 0.4}, 0.02});
      const std::vector<std::uint8_t> all(rod.positions.size(), 1);
      found.add(crossings_between(CrossingSurface(cloth.positions, cloth.triangles, {}, half),
                                  CrossingSurface(rod.positions, rod.triangles, {}, all)));
    }
    return found;
  };
  EXPECT_EQ(through({-0.3}).crossings, 1);
  EXPECT_EQ(through({-0.3}).placed, 0);
  EXPECT_EQ(through({0.3}).crossings, 0);
  EXPECT_EQ(through({0.3}).placed, 1);
  EXPECT_EQ(through({0.0}).placed, 1) << "a curve that goes on in placed cloth";
  EXPECT_EQ(through({-0.3, 0.0, 0.3}).crossings, 1);
  // Free cloth through placed cloth is the work of what moves.
  const Mesh other = {{{0.3, 0.01, -0.1}, {0.3, 0.02, 0.1}, {0.33, 0.015, 0.1}}, {{0, 1, 2}}};
  const CrossingSurface placed(cloth.positions, cloth.triangles, {}, half);
  EXPECT_EQ(crossings_between(placed, other.view()).crossings, 1);
  EXPECT_EQ(crossings_between(other.view(), placed).crossings, 1);
  // Without flags nothing is placed.
  EXPECT_EQ(crossings_between(cloth.view(), solid({{0.3, 0, -0.4}, {0.3, 0, 0.4}, 0.02}).view()).placed, 0);
}

TEST(SurfaceCrossings, AFingerThroughASheetIsOneHoweverFineTheSheet) {
  for (const int n : {1, 4, 13, 40}) {
    const Mesh cloth = sheet(n, 0.0, 0.3);
    const SurfaceCrossings found =
        crossings_between(cloth.view(), solid({{0.03, 0.02, -0.4}, {0.04, 0.05, 0.4}, 0.05}).view());
    EXPECT_EQ(found.crossings, 1) << n;
    EXPECT_GE(found.pairs, 3) << n;
    EXPECT_EQ(crossings_within(cloth.view()).pairs, 0) << n;
  }
}

TEST(SurfaceCrossings, ANeedleThroughOneTriangleIsSeen) {
  const Mesh cloth = sheet(3, 0.0, 0.0);
  const SurfaceCrossings found =
      crossings_between(cloth.view(), solid({{0.07, 0.02, -0.4}, {0.07, 0.02, 0.4}, 1e-6}).view());
  EXPECT_EQ(found.crossings, 1);
}

TEST(SurfaceCrossings, AGrazingEdgeIsCountedOnce) {
  // One edge of a standing triangle lies exactly across the edge, or the corner, that triangles of the sheet share.
  for (const bool at_corner : {false, true}) {
    const Mesh cloth = sheet(2, 0.0, 0.0);
    const double x = at_corner ? 0.0 : 0.25;
    const Mesh blade = {{{x, 0, -1}, {x, 0, 1}, {x + 9, 0.1, 0}}, {{0, 1, 2}}};
    const SurfaceCrossings found = crossings_between(cloth.view(), blade.view());
    EXPECT_EQ(found.crossings, 1) << at_corner;
    const Mesh needle = {{{x, 0, -1}, {x, 0, 1}, {x, 1e-9, 1}}, {{0, 1, 2}}};
    EXPECT_EQ(crossings_between(cloth.view(), needle.view()).crossings, 1) << at_corner;
  }
}

TEST(SurfaceCrossings, BothWallsOfATubeAreTwo) {
  const Mesh tube = solid({{0, -0.5, 0}, {0, 0.5, 0}, 0.2}, 24);
  const Mesh arm = solid({{-0.5, 0.01, 0.02}, {0.5, 0.03, 0.01}, 0.04});
  EXPECT_EQ(crossings_between(tube.view(), arm.view()).crossings, 2);
}

TEST(SurfaceCrossings, NothingWhereNothingCrosses) {
  const Mesh cloth = sheet(20, 0.0, 0.2);
  for (const Capsule& beside : {Capsule{{-0.4, 0, 0.07}, {0.4, 0, 0.07}, 0.05},
                                {{0.7, 0, -1}, {0.7, 0, 1}, 0.1},
                                {{0, 0, 0.2}, {0, 0, 0.2}, 0.15}})
    EXPECT_EQ(crossings_between(cloth.view(), solid(beside).view()).pairs, 0);
  EXPECT_EQ(crossings_between(cloth.view(), Mesh().view()).pairs, 0);
  EXPECT_EQ(crossings_within(Mesh().view()).pairs, 0);
}

TEST(SurfaceCrossings, WhatIsFlushDoesNotCross) {
  const Mesh lower = sheet(7, 0.0, 0.0, 1), upper = sheet(7, 0.0, 0.0, 2);
  EXPECT_EQ(crossings_between(lower.view(), upper.view()).pairs, 0);
  EXPECT_EQ(crossings_between(upper.view(), lower.view()).pairs, 0);
  Mesh folded = lower; // two layers in one surface
  for (const Vec3& p : upper.positions) folded.positions.push_back(p);
  for (rig::Triangle t : upper.triangles) {
    for (auto& corner : t) corner += static_cast<std::uint32_t>(lower.positions.size());
    folded.triangles.push_back(t);
  }
  EXPECT_EQ(crossings_within(folded.view()).pairs, 0);
}

TEST(SurfaceCrossings, ASheetThroughItselfIsSeenAndASeamIsNot) {
  // A band around the y axis whose ends pass through each other: a strip of n cells.
  const auto band = [](int n, double turns) {
    Mesh mesh;
    for (int k = 0; k <= n; ++k) {
      const double turn = 2.0 * std::numbers::pi * turns * k / n;
      for (const double y : {-0.1, 0.1}) mesh.positions.push_back(Vec3(std::cos(turn), y, std::sin(turn)));
    }
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(n); ++k) {
      mesh.triangles.push_back({2 * k, 2 * k + 1, 2 * k + 3});
      mesh.triangles.push_back({2 * k, 2 * k + 3, 2 * k + 2});
    }
    return mesh;
  };
  Mesh crossed = band(20, 1.0);
  for (int i : {0, 1}) crossed.positions[i] += Vec3(0.3, 0, 0.3);
  for (int i : {40, 41}) crossed.positions[i] += Vec3(0.3, 0, 0.3);
  crossed.positions[40].x() -= 0.2;
  crossed.positions[41].x() -= 0.2;
  crossed.positions[40].z() += 0.4;
  crossed.positions[41].z() += 0.4;
  EXPECT_EQ(crossings_within(crossed.view()).crossings, 1);

  Mesh shut = band(20, 1.0);
  shut.positions[40] = shut.positions[0];
  shut.positions[41] = shut.positions[1];
  const std::vector<std::pair<int, int>> seam = {{0, 40}, {1, 41}};
  EXPECT_EQ(crossings_within(CrossingSurface(shut.positions, shut.triangles, seam)).pairs, 0);
}

TEST(SurfaceCrossings, WhatIsNoPlaceIsNotThere) {
  const Mesh needle = solid({{0.07, 0.02, -0.4}, {0.07, 0.02, 0.4}, 0.01});
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
    Mesh cloth = sheet(3, 0.0, 0.0);
    EXPECT_EQ(crossings_between(cloth.view(), needle.view()).crossings, 1);
    for (Vec3& p : cloth.positions) p.y() = bad;
    EXPECT_EQ(crossings_between(cloth.view(), needle.view()).pairs, 0) << bad;
    EXPECT_EQ(crossings_within(cloth.view()).pairs, 0) << bad;
  }
  Mesh tiny = sheet(3, 1e-300, 0.0);
  EXPECT_EQ(crossings_between(tiny.view(), needle.view()).crossings, 1);
}

TEST(CapsuleTriangles, IsShutLiesOnTheSolidAndIsNoDeeperThanItSays) {
  std::mt19937_64 random(13);
  for (int trial = 0; trial < 60; ++trial) {
    const Vec3 a = test::random_point(random, 0.3), b = trial % 5 ? test::random_point(random, 0.3) : a;
    const double radius = 0.1, taper = trial % 5 ? test::random_taper(random, radius, trial) : 0.0;
    const Capsule capsule{a, trial % 7 ? b : a + 0.1 * (b - a), radius, taper}; // some hold their other end
    const int around = 3 + trial % 30;
    const CapsuleTriangles surface = capsule_surface(capsule, around);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    double volume = 0.0;
    const double cosine = std::cos(std::numbers::pi / around);
    const double sag = capsule.widest() * (1.0 - cosine * cosine);
    for (const rig::Triangle& t : surface.triangles) {
      for (int k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
      const Vec3 &p = surface.positions[t[0]], &q = surface.positions[t[1]], &r = surface.positions[t[2]];
      volume += (p - a).dot((q - a).cross(r - a)) / 6.0;
      EXPECT_GE(signed_distance((p + q + r) / 3.0, capsule).distance, -sag - 1e-12) << "trial " << trial;
    }
    for (const auto& [side, count] : sides) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(sides.count({side.second, side.first}), 1u);
    }
    EXPECT_GT(volume, 0.0) << "normals point out";
    for (const Vec3& p : surface.positions) EXPECT_NEAR(signed_distance(p, capsule).distance, 0.0, 1e-12);
  }
}

} // namespace
