// The search for the least model, over a measurer that measures nothing.
#include "src/study/plan/plan_search.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <random>

using namespace tutu::app;

namespace {

/// Errors and costs by formula; remembers what was asked.
struct FakeScene {
  std::vector<PlanAxis> axes;
  std::vector<double> weight, price; ///< of a level on each axis
  double base = 0.0;                 ///< error that stays
  double luck = 0.0;                 ///< how much worse verifying may find a model, at most
  std::uint64_t seed = 0;
  std::map<PlanLevels, PlanFigures> measured;
  std::map<PlanLevels, double> verified;
  int calls = 0, most_calls = 1 << 30;

  double noise(const PlanLevels& levels) const {
    std::uint64_t h = seed;
    for (const int level : levels) h = (h ^ static_cast<std::uint64_t>(level + 1)) * 1099511628211ull;
    return static_cast<double>(h >> 40) * 0x1p-24;
  }
  double excess(const PlanLevels& levels) const {
    double sum = base;
    for (std::size_t k = 0; k < axes.size(); ++k) sum += weight[k] / (1.0 + levels[k]);
    return sum * (1.0 + 0.2 * noise(levels));
  }
  double cost(const PlanLevels& levels) const {
    double sum = 0.1;
    for (std::size_t k = 0; k < axes.size(); ++k) sum += price[k] * levels[k];
    return sum;
  }
  PlanMeasurer measurer() {
    PlanMeasurer m;
    m.measure = [this](const PlanLevels& levels) {
      ++calls;
      EXPECT_FALSE(measured.contains(levels)) << "asked twice";
      return measured[levels] = {excess(levels), cost(levels)};
    };
    m.verify = [this](const PlanLevels& levels) {
      ++calls;
      return verified[levels] = excess(levels) * (1.0 + luck * noise({static_cast<int>(1e3 * noise(levels))}));
    };
    m.cost_ratio = [this](const PlanLevels& a, const PlanLevels& b) {
      ++calls;
      return cost(a) / cost(b);
    };
    m.go_on = [this] { return calls < most_calls; };
    return m;
  }
  bool verified_bad(const PlanLevels& levels) const {
    const auto found = verified.find(levels);
    return found != verified.end() && found->second > 1.0;
  }
};

FakeScene random_scene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto number = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  FakeScene scene;
  scene.seed = random();
  const int axes = 1 + static_cast<int>(4 * number());
  for (int k = 0; k < axes; ++k) {
    const int values = 1 + static_cast<int>(9 * number());
    scene.axes.push_back({values, static_cast<int>(values * number()), number() < 0.3});
    scene.weight.push_back(1.2 * number());
    scene.price.push_back(number() < 0.2 ? 0.0 : number());
  }
  scene.base = 0.5 * number();
  if (seed % 3 == 0) scene.luck = 0.4;
  return scene;
}

TEST(PlanSearch, TheBestIsNeverWorseThanWhatWasMeasured) {
  int good = 0, bad = 0, mended = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    FakeScene scene = random_scene(seed);
    std::optional<double> budget;
    if (seed % 4 == 1) budget = 0.1 + 0.5 * static_cast<double>(seed % 7);
    const PlanResult result = find_plan(scene.axes, scene.measurer(), budget);
    ASSERT_EQ(result.levels.size(), scene.axes.size());
    ASSERT_FALSE(result.interrupted);
    const auto in_budget = [&](const PlanFigures& f) { return !budget || f.ms <= *budget; };
    // Whether some model was measured that is good, was not found bad later, and is within the budget if any is.
    bool any_in_budget = false, any_good = false;
    for (const auto& [levels, f] : scene.measured) any_in_budget = any_in_budget || in_budget(f);
    for (const auto& [levels, f] : scene.measured)
      any_good = any_good || (f.good() && !scene.verified_bad(levels) && (in_budget(f) || !any_in_budget));
    EXPECT_EQ(result.good, any_good) << "seed " << seed;
    EXPECT_EQ(result.in_budget, any_in_budget) << "seed " << seed;
    if (result.good) {
      ASSERT_TRUE(scene.verified.contains(result.levels));
      EXPECT_LE(scene.verified.at(result.levels), 1.0);
      EXPECT_LE(result.excess, 1.0);
    } else {
      EXPECT_GT(result.excess, 1.0);
      for (const auto& [levels, f] : scene.measured) {
        const double worse = scene.verified.contains(levels) ? std::max(f.excess, scene.verified.at(levels)) : f.excess;
        if (in_budget(f) == result.in_budget) {
          EXPECT_LE(result.excess, worse) << "seed " << seed;
        }
      }
    }
    (result.good ? good : bad) += 1;
    for (const auto& [levels, excess] : scene.verified) mended += excess > 1.0 && result.good;
  }
  EXPECT_GT(good, 900); // the scenes are of every kind
  EXPECT_GT(bad, 300);
  EXPECT_GT(mended, 30);
}

TEST(PlanSearch, ItCostsNoMoreThanTheOwnWhereThatIsGood) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    FakeScene scene = random_scene(seed);
    scene.luck = 0.0;
    const PlanResult result = find_plan(scene.axes, scene.measurer(), {});
    if (result.own.good() && result.good) {
      EXPECT_LE(result.ms, result.own.ms * (1 + 1e-9)) << "seed " << seed;
    }
    for (const PlanTrial& trial : result.trials)
      if (trial.end == PlanTrial::End::kept && trial.cost_ratio) {
        EXPECT_LT(*trial.cost_ratio, 1.0 - k_least_saving);
      }
  }
}

TEST(PlanSearch, BisectionFindsTheLeastOfOneAxis) {
  for (int needed = 0; needed < 20; ++needed) {
    std::vector<PlanLevels> asked;
    PlanMeasurer m;
    m.measure = [&](const PlanLevels& levels) {
      asked.push_back(levels);
      return PlanFigures{levels[0] >= needed ? 0.5 : 2.0 + needed - levels[0], 1.0 + levels[0]};
    };
    m.verify = [&](const PlanLevels& levels) { return levels[0] >= needed ? 0.5 : 2.0; };
    m.cost_ratio = [](const PlanLevels& a, const PlanLevels& b) { return (1.0 + a[0]) / (1.0 + b[0]); };
    m.go_on = [] { return true; };
    const std::vector<PlanAxis> axes = {{24, 12}};
    const PlanResult result = find_plan(axes, m, {});
    EXPECT_TRUE(result.good);
    EXPECT_EQ(result.levels, PlanLevels{needed});
    EXPECT_LE(asked.size(), needed <= 12 ? 5u : 9u);
  }
}

TEST(PlanSearch, WhatHelpsMakesMoreChoicesGood) {
  // Alone the cheaper value of the second axis is too wrong; with one level of the first, which costs little, it is
  // not.
  PlanMeasurer m;
  const auto excess = [](const PlanLevels& levels) { return 0.5 + 0.7 * (1 - levels[1]) - 0.4 * levels[0]; };
  const auto cost = [](const PlanLevels& levels) { return 1.0 + levels[1] + 0.1 * levels[0]; };
  m.measure = [&](const PlanLevels& levels) { return PlanFigures{excess(levels), cost(levels)}; };
  m.verify = excess;
  m.cost_ratio = [&](const PlanLevels& a, const PlanLevels& b) { return cost(a) / cost(b); };
  m.go_on = [] { return true; };
  for (const bool helps : {false, true}) {
    const std::vector<PlanAxis> axes = {{3, 0, helps}, {2, 1}};
    const PlanResult result = find_plan(axes, m, {});
    EXPECT_TRUE(result.good);
    EXPECT_EQ(result.levels, helps ? (PlanLevels{1, 0}) : (PlanLevels{0, 1}));
  }
}

TEST(PlanSearch, TwoErrorsThatTwoHelpersLowerAreMetTogether) {
  // The second axis at 0 makes both errors too large; each helper alone lowers one and raises the other.
  PlanMeasurer m;
  const auto excess = [](const PlanLevels& l) {
    const double one = 1.5 - 0.5 * l[0] + 0.2 * l[1] - 1.0 * l[2], other = 1.5 - 0.6 * l[1] + 0.2 * l[0] - 1.0 * l[2];
    return std::max(one, other);
  };
  m.measure = [&](const PlanLevels& levels) { return PlanFigures{excess(levels), 1.0 + levels[2]}; };
  m.verify = excess;
  m.cost_ratio = [](const PlanLevels& a, const PlanLevels& b) { return (1.0 + a[2]) / (1.0 + b[2]); };
  m.go_on = [] { return true; };
  const std::vector<PlanAxis> axes = {{4, 0, true}, {3, 0, true}, {2, 1}};
  const PlanResult result = find_plan(axes, m, {});
  EXPECT_TRUE(result.good);
  EXPECT_EQ(result.levels[2], 0);
}

TEST(PlanSearch, WhatCountsIsLeftOutWhateverTheClockSays) {
  PlanMeasurer m;
  m.measure = [](const PlanLevels&) { return PlanFigures{0.5, 1.0}; };
  m.verify = [](const PlanLevels&) { return 0.5; };
  m.cost_ratio = [](const PlanLevels&, const PlanLevels&) { return 1.01; };
  m.go_on = [] { return true; };
  const std::vector<PlanAxis> axes = {{2, 1, false, true}, {2, 1, false, false}};
  EXPECT_EQ(find_plan(axes, m, {}).levels, (PlanLevels{0, 1}));
}

TEST(PlanSearch, AnInterruptLeavesTheBestSoFar) {
  for (std::uint64_t seed = 0; seed < 300; ++seed)
    for (const int calls : {0, 1, 3, 6}) {
      FakeScene scene = random_scene(seed);
      scene.most_calls = calls;
      const PlanResult result = find_plan(scene.axes, scene.measurer(), {});
      ASSERT_EQ(result.levels.size(), scene.axes.size());
      if (!result.interrupted) continue;
      EXPECT_FALSE(result.good && !scene.verified.contains(result.levels));
      // The last call was cut short and does not count.
      int seen_good = 0;
      for (const auto& [levels, f] : scene.measured) seen_good += f.good();
      if (seen_good > 1 && scene.verified.empty()) {
        EXPECT_LE(result.excess, 1.0);
      }
    }
}

} // namespace
