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

/// 3 x 3 particles of a metre a cell; the first row held.
Garment held_sheet() {
  GarmentDescription description;
  description.shape = GridShape{3, 3, {0, 0, 0}, {2, 0, 0}, {0, -2, 0}};
  description.attachments = {{"stage", 0, 0, 0, -1}};
  return build_garment(description);
}

TEST(Metrics, ThreadsLongerAndShorterAndHeldAreKeptApart) {
  const Garment garment = held_sheet();
  const MeasuredParts parts(garment);
  EXPECT_EQ(parts.held_threads.size(), 2u);
  EXPECT_EQ(parts.free_threads.size(), 10u);
  EXPECT_EQ(parts.free_triangles.size(), garment.triangles.size());
  Particles particles{garment.rest_positions, {}};
  EXPECT_EQ(longest_thread(parts, particles.positions).longer, 0.0);

  particles.positions[7].y() -= 1.5; // of the middle column: the thread above it is 2.5 m, those beside it too
  particles.positions[0].x() -= 3.0; // held: four metres from its neighbour, and the free thread below it is longer
  const std::vector<double> strains = strains_of(garment, particles);
  ThreadStrainGatherer gatherer;
  gatherer.add(parts, particles.positions);
  for (const ThreadStrains& found : {thread_strains(parts, particles.positions), gatherer.strains()}) {
    EXPECT_NEAR(found.longer.max, std::sqrt(10.0) - 1.0, 1e-15);
    EXPECT_NEAR(found.held_longer.max, 3.0, 1e-15);
    EXPECT_NEAR(found.held_longer.mean, 1.5, 1e-15);
    EXPECT_EQ(found.shorter.max, 0.0);
  }
  const LongestThread longest = longest_thread(parts, particles.positions);
  EXPECT_NEAR(longest.longer, std::sqrt(10.0) - 1.0, 1e-15);
  EXPECT_EQ(std::minmax(longest.i, longest.j), std::minmax(0, 3));
  EXPECT_EQ(*std::max_element(strains.begin(), strains.end()), 3.0) << "all threads, held ones among them";

  particles.positions[8] = particles.positions[5] + Vec3(0, -0.25, 0); // the last thread of the last column
  const ThreadStrains pressed = thread_strains(parts, particles.positions);
  EXPECT_NEAR(pressed.shorter.max, 0.75, 1e-15);
  EXPECT_NEAR(pressed.shorter.mean, 0.075, 1e-15);
}

TEST(Metrics, GatheredStrainsAreThoseOfAllFrames) {
  const Garment garment = held_sheet();
  const MeasuredParts parts(garment);
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 0.3);
  ThreadStrainGatherer gatherer;
  std::vector<double> longer, shorter;
  for (int frame = 0; frame < 50; ++frame) {
    Particles particles{garment.rest_positions, {}};
    for (Vec3& p : particles.positions) p += Vec3(noise(random), noise(random), noise(random));
    gatherer.add(parts, particles.positions);
    const std::vector<double> strains = strains_of(garment, particles);
    for (const int k : parts.free_threads) {
      longer.push_back(std::max(strains[k], 0.0));
      shorter.push_back(std::max(-strains[k], 0.0));
    }
  }
  for (const auto& [found, samples] :
       {std::pair(gatherer.strains().longer, longer), std::pair(gatherer.strains().shorter, shorter)}) {
    const Spread exact = spread(samples);
    EXPECT_EQ(found.max, exact.max);
    EXPECT_NEAR(found.mean, exact.mean, 1e-12);
    EXPECT_NEAR(found.p99, exact.p99, 0.011 * exact.p99);
  }
}

TEST(Metrics, JitterIsTheSecondDifference) {
  Garment garment;
  garment.rest_positions.resize(2);
  const std::vector<Vec3> a = {{0, 0, 0}, {1, 0, 0}}, b = {{0, 0, 0}, {2, 0, 0}}, c = {{0, 1e-4, 0}, {3, 0, 0}};
  EXPECT_NEAR(jitter_of(MeasuredParts(garment), a, b, c, 1.0 / 60.0), 0.5 * 1e-4 * 3600.0, 1e-12);
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
