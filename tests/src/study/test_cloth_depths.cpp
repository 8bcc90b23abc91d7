// How deep cloth is in proxies and in the true body, against asking every point; and what a run says when it ends so.
#include "proxies/distance/signed_distance.h"
#include "src/measure/run_end.h"
#include "tests/support/capsule_character.h"

#include <gmock/gmock.h>
#include <random>

using namespace tutu;
using namespace tutu::app;
using proxies::Capsule;

namespace {

/// 9 x 9 particles, 0.4 m a side, level at height 0; the first row and one more particle held.
cloth::Garment sheet() {
  cloth::GarmentDescription description;
  description.name = "sheet";
  description.shape = cloth::GridShape{9, 9, {-0.2, 0, -0.2}, {0.4, 0, 0}, {0, 0, 0.4}};
  description.attachments = {{"stage", 0, 0, 0, -1}, {"stage", 4, 4, 4, 4}};
  return cloth::build_garment(description);
}

/// Every point asked, none passed over.
template <class Distance>
ClothDepths by_brute_force(const cloth::Garment& garment, const std::vector<Vec3>& x, const Distance& distance) {
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment);
  ClothDepths all;
  const auto depth = [&](const Vec3& p) { return std::max(0.0, -distance(p)); };
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!pinned[i]) all.particles.add(depth(x[i]));
  for (const auto& t : garment.triangles) {
    if (pinned[t[0]] && pinned[t[1]] && pinned[t[2]]) continue;
    all.triangles.add(depth((x[t[0]] + x[t[1]] + x[t[2]]) / 3.0));
    int samples = 0;
    for (int i = 0; i <= 6; ++i)
      for (int j = 0; i + j <= 6; ++j, ++samples) {
        const std::array<int, 3> parts = {i, j, 6 - i - j};
        bool free = false;
        Vec3 p = Vec3::Zero();
        for (int k = 0; k < 3; ++k) {
          p += parts[k] / 6.0 * x[t[k]];
          free = free || (parts[k] > 0 && !pinned[t[k]]);
        }
        if (free) all.surface = std::max(all.surface, depth(p));
      }
    EXPECT_EQ(samples, k_surface_samples);
  }
  return all;
}

void expect_same(const ClothDepths& found, const ClothDepths& expected, int trial) {
  for (const auto& [a, b] :
       {std::pair(&found.particles, &expected.particles), std::pair(&found.triangles, &expected.triangles)}) {
    EXPECT_EQ(a->asked, b->asked) << trial;
    EXPECT_EQ(a->inside, b->inside) << trial;
    EXPECT_NEAR(a->deepest, b->deepest, 1e-12) << trial;
    EXPECT_NEAR(a->sum, b->sum, 1e-10) << trial;
  }
  EXPECT_NEAR(found.surface, expected.surface, 1e-12) << trial;
  EXPECT_EQ(found.surface_particle >= 0, expected.surface > 0.0) << trial;
}

TEST(ClothDepths, InProxiesAreThoseOfBruteForce) {
  const cloth::Garment garment = sheet();
  const ClothProbe probe(garment);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-0.3, 0.3), size(0.01, 0.06), shake(-0.02, 0.02);
  int inside = 0, deeper_between = 0;
  constexpr int k_trials = 300;
  for (int trial = 0; trial < k_trials; ++trial) {
    std::vector<Vec3> x = garment.rest_positions;
    for (Vec3& p : x) p += Vec3(shake(random), shake(random), shake(random));
    std::vector<Capsule> capsules(1 + trial % 4);
    for (Capsule& c : capsules) {
      c.a = {place(random), place(random), place(random)};
      c.b = trial % 3 == 0 ? c.a : Vec3(place(random), place(random), place(random));
      c.radius = size(random);
    }
    std::optional<proxies::Plane> ground;
    if (trial % 5 == 0) ground = proxies::Plane{Vec3::UnitY(), -0.015};
    const ClothDepths expected = by_brute_force(garment, x, [&](const Vec3& p) {
      double nearest = ground ? proxies::signed_distance(p, *ground).distance : 1e9;
      for (const Capsule& c : capsules) nearest = std::min(nearest, proxies::signed_distance(p, c).distance);
      return nearest;
    });
    ClothDepths found;
    probe.measure(capsules, ground, x, found);
    expect_same(found, expected, trial);
    inside += expected.surface > 0.0;
    deeper_between += expected.surface > expected.particles.deepest + 1e-6;
  }
  EXPECT_GT(inside, 3 * k_trials / 10);
  EXPECT_LT(inside, 9 * k_trials / 10);
  EXPECT_GT(deeper_between, k_trials / 10) << "what particles alone do not show";
}

TEST(ClothDepths, InTheBodyAreThoseOfBruteForce) {
  const cloth::Garment garment = sheet();
  const ClothProbe probe(garment);
  test::CapsuleBody shape;
  shape.add({{0, -0.1, 0}, {0.1, 0.1, 0.05}, 0.08}, 16, 4, 4);
  const proxies::BodyMesh body(shape.positions, shape.triangles);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> away(-0.3, 0.3), shake(-0.02, 0.02);
  int inside = 0;
  constexpr int k_trials = 60;
  for (int trial = 0; trial < k_trials; ++trial) {
    const Vec3 moved(away(random), away(random), away(random));
    std::vector<Vec3> x = garment.rest_positions;
    for (Vec3& p : x) p += moved + Vec3(shake(random), shake(random), shake(random));
    const ClothDepths expected =
        by_brute_force(garment, x, [&](const Vec3& p) { return body.signed_distance(p).distance; });
    ClothDepths found;
    probe.measure(body, x, found);
    expect_same(found, expected, trial);
    inside += expected.surface > 0.0;
  }
  EXPECT_GT(inside, 3 * k_trials / 10);
  EXPECT_LT(inside, 8 * k_trials / 10);
}

TEST(ClothDepths, AChordBetweenPinsIsNoWorkOfTheSolver) {
  const cloth::Garment garment = sheet();
  const ClothProbe probe(garment);
  // A ball in the middle of the first thread of the held row, with no other point of a triangle in it.
  const Vec3 middle = 0.5 * (garment.rest_positions[0] + garment.rest_positions[1]);
  ClothDepths held, free;
  probe.measure(std::vector<Capsule>{{middle, middle, 0.003}}, std::nullopt, garment.rest_positions, held);
  EXPECT_EQ(held.surface, 0.0);
  const Vec3 below = 0.5 * (garment.rest_positions[9] + garment.rest_positions[10]);
  probe.measure(std::vector<Capsule>{{below, below, 0.003}}, std::nullopt, garment.rest_positions, free);
  EXPECT_NEAR(free.surface, 0.003, 1e-15);
  EXPECT_EQ(free.particles.deepest, 0.0) << "particles do not see it";
  EXPECT_THAT(free.surface_particle, ::testing::AnyOf(9, 10));
}

TEST(RunEnd, SaysWhatIsTooLongOrTooDeep) {
  const cloth::Garment garment = sheet();
  const ClothProbe probe(garment);
  std::vector<Vec3> x = garment.rest_positions;
  const auto end = [&](double radius) {
    ClothDepths depths;
    probe.measure(std::vector<Capsule>{{x[80], x[80], radius}}, std::nullopt, x, depths);
    return RunEnd{{{garment.name, cloth::longest_thread(probe.parts(), x), deepest_of(depths), {}}}};
  };
  EXPECT_EQ(end(0.02).warning(), "") << "20 mm are allowed";
  EXPECT_EQ(end(0.02).json().at("warning"), nullptr);
  EXPECT_EQ(end(0.031).warning(), "sheet ends with its surface 31 mm deep in the proxies (by particle 80)");
  x[80].z() += 0.0499; // the thread along the last column is twice as long, to a hair
  EXPECT_EQ(end(0.001).warning(), "");
  x[80] = x[71] + Vec3(0, 0, 0.05 * 5.37); // 437 % longer than 50 mm; and the one across is shorter than that
  EXPECT_EQ(end(0.001).warning(), "sheet ends with a thread 437 % longer than at rest (particles 71 - 80)");
  const RunEnd both = end(0.05);
  EXPECT_EQ(both.warning(),
            "sheet ends with a thread 437 % longer than at rest (particles 71 - 80) and its surface 50 mm "
            "deep in the proxies (by particle 80)");
  EXPECT_NEAR(both.json().at("garments").at(0).at("longer_pct").get<double>(), 437.0, 1e-9);
  EXPECT_NEAR(both.json().at("garments").at(0).at("surface_mm").at("proxies").get<double>(), 50.0, 1e-9);
  x[0].x() -= 1.0; // held, as its neighbour in the row is; the thread below it is free
  EXPECT_THAT(both.warning(), ::testing::HasSubstr("71 - 80"));
  EXPECT_THAT(end(0.001).warning(), ::testing::HasSubstr("particles 0 - 9"));
  RunEnd placed = end(0.001);
  placed.garments[0].longest_at = "between arm and torso";
  EXPECT_THAT(placed.warning(), ::testing::HasSubstr("(particles 0 - 9, between arm and torso)"));
  EXPECT_EQ(placed.json().at("garments").at(0).at("thread_at"), "between arm and torso");
}

TEST(RunEnd, SaysBetweenWhichProxiesAPlaceIs) {
  const auto upright = [](double x) { return Capsule{{x, 0, 0}, {x, 1, 0}, 0.1}; };
  const std::vector<Capsule> colliders = {upright(0.0), upright(0.23), upright(-0.04)};
  std::vector<proxies::Proxy> proxies(3);
  proxies[0].name = "torso";
  proxies[1].name = "arm";
  proxies[2].name = "back";
  EXPECT_EQ(place_among({0.12, 0.5, 0}, colliders, proxies), "between arm and torso") << "the nearest first";
  EXPECT_EQ(place_among({0.11, 0.5, 0}, colliders, proxies), "between torso and arm");
  EXPECT_EQ(place_among({0.34, 0.5, 0}, colliders, proxies), "by arm");
  EXPECT_EQ(place_among({0.39, 0.5, 0}, colliders, proxies), "");
  EXPECT_EQ(place_among({0, 0, 0}, {}, {}), "");
}

} // namespace
