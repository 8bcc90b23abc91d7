#include "cloth/garment/drape_file.h"
#include "cloth/metrics.h"
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>
#include <numeric>
#include <random>

using namespace tutu;
using namespace tutu::cloth;

namespace {

TEST(Metrics, PercentileIsTheNearestRank) {
  std::vector<double> samples(100);
  std::iota(samples.begin(), samples.end(), 1.0);
  std::shuffle(samples.begin(), samples.end(), std::mt19937(4));
  EXPECT_EQ(percentile(samples, 0.99), 99.0);
  EXPECT_EQ(percentile(samples, 0.5), 50.0);
  EXPECT_EQ(percentile(samples, 1.0), 100.0);
  EXPECT_EQ(percentile(samples, 0.0), 1.0);
  std::vector<double> none;
  EXPECT_EQ(percentile(none, 0.5), 0.0);
}

TEST(Metrics, SpreadOfKnownSamples) {
  const Spread s = spread({3.0, 1.0, 2.0});
  EXPECT_EQ(s.max, 3.0);
  EXPECT_EQ(s.mean, 2.0);
  EXPECT_EQ(s.p99, 3.0);
}

TEST(Metrics, AGatheredSpreadIsTheSpreadOfTheSamples) {
  std::mt19937_64 random(6);
  std::lognormal_distribution<double> skewed(-3.0, 2.0);
  std::vector<double> samples(20000);
  SpreadGatherer gatherer;
  for (double& s : samples) {
    s = random() % 4 == 0 ? 0.0 : skewed(random);
    gatherer.add(s);
  }
  const Spread exact = spread(samples), gathered = gatherer.spread();
  EXPECT_EQ(gathered.max, exact.max);
  EXPECT_NEAR(gathered.mean, exact.mean, 1e-12 * exact.mean * 20000);
  EXPECT_GE(gathered.p99, exact.p99);
  EXPECT_LE(gathered.p99, 1.011 * exact.p99);
  EXPECT_EQ(SpreadGatherer().spread().max, 0.0);
  SpreadGatherer zeros;
  zeros.add(0.0);
  EXPECT_EQ(zeros.spread().p99, 0.0);
}

TEST(Metrics, PercentilesOfAFewAreExactAndOfManyBounded) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> skewed(-1.0, 1.0);
  std::vector<double> samples;
  PercentileGatherer gatherer;
  EXPECT_EQ(gatherer.percentile(0.5), 0.0);
  for (const std::size_t count : {std::size_t{1}, std::size_t{99}, PercentileGatherer::k_exact,
                                  PercentileGatherer::k_exact + 1, 3 * PercentileGatherer::k_exact}) {
    while (samples.size() < count) {
      samples.push_back(skewed(random));
      gatherer.add(samples.back());
    }
    for (const double share : {0.0, 0.1, 0.5, 0.99, 1.0}) {
      std::vector<double> all = samples;
      const double exact = percentile(all, share), gathered = gatherer.percentile(share);
      if (count <= PercentileGatherer::k_exact) {
        EXPECT_EQ(gathered, exact) << count << ' ' << share;
      } else if (share > 0.0) {
        EXPECT_GE(gathered, exact) << count << ' ' << share;
        EXPECT_LE(gathered, 1.011 * exact) << count << ' ' << share;
      }
    }
  }
}

TEST(Metrics, PenetrationIsTheDeepestOverAllColliders) {
  Garment garment;
  garment.rest_positions.resize(3);
  garment.pins = {{2, 0}};
  Particles particles;
  particles.positions = {{0.05, 0, 0}, {5, 0, 0}, {0, 0, 0}};
  const std::vector<proxies::Capsule> colliders = {{{0, 0, 0}, {0, 0, 0}, 0.1}, {{0, 0, 0}, {1, 0, 0}, 0.08}};
  const std::vector<double> depths = penetration_of(garment, particles, colliders, std::nullopt);
  ASSERT_EQ(depths.size(), 2u) << "the pinned particle does not count";
  EXPECT_NEAR(depths[0], 0.08, 1e-15);
  EXPECT_EQ(depths[1], 0.0);
}

TEST(Metrics, JitterIsTheSecondDifference) {
  Garment garment;
  garment.rest_positions.resize(2);
  const std::vector<Vec3> a = {{0, 0, 0}, {1, 0, 0}}, b = {{0, 0, 0}, {2, 0, 0}}, c = {{0, 1e-4, 0}, {3, 0, 0}};
  EXPECT_NEAR(jitter_of(garment, a, b, c, 1.0 / 60.0), 0.5 * 1e-4 * 3600.0, 1e-12);
}

TEST(StateHash, SeesEveryBitAndTheOrder) {
  Particles particles;
  particles.positions = {{1, 2, 3}, {4, 5, 6}};
  particles.velocities = {{0, 0, 0}, {0, 0, 0}};
  const std::uint64_t hash = state_hash(particles);
  Particles other = particles;
  other.positions[0].x() = std::nextafter(1.0, 2.0);
  EXPECT_NE(state_hash(other), hash);
  other = particles;
  other.positions[0].x() = -1.0;
  other.positions[1].x() = -4.0;
  EXPECT_NE(state_hash(other), hash) << "two signs do not cancel";
  std::swap(particles.positions[0], particles.positions[1]);
  EXPECT_NE(state_hash(particles), hash);
}

TEST(DrapeFile, RoundTripKeepsEveryBit) {
  const auto folder = test::scratch_folder();
  std::mt19937_64 random(5);
  std::normal_distribution<double> gauss;
  Drape drape{0xfedcba9876543210ull, {{"skirt \"quoted\"", {}}, {"top", {}}}};
  for (DrapedGarment& garment : drape.garments)
    for (int i = 0; i < 50; ++i) garment.positions.emplace_back(gauss(random), gauss(random), 1e-9 * gauss(random));
  write_drape(drape, folder / "d.json");
  const Drape back = read_drape(folder / "d.json");
  EXPECT_EQ(back.fingerprint, drape.fingerprint);
  ASSERT_EQ(back.garments.size(), 2u);
  for (int g = 0; g < 2; ++g) {
    EXPECT_EQ(back.garments[g].name, drape.garments[g].name);
    EXPECT_EQ(back.garments[g].positions, drape.garments[g].positions);
  }
  write_file(folder / "bad.json", R"({"fingerprint": "xyz", "garments": []})");
  EXPECT_THROW(read_drape(folder / "bad.json"), InputError);
  std::filesystem::remove_all(folder);
}

} // namespace
