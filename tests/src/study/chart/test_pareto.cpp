// The Pareto front and the statistics of a chart, against their definitions on random points.
#include "src/study/chart/chart_points.h"
#include "src/study/chart/pareto.h"

#include <algorithm>
#include <array>
#include <gmock/gmock.h>
#include <random>

using namespace tutu::app;

namespace {

/// Few different values, so that many are equal in one or both.
std::vector<CostAndError> random_points(std::mt19937_64& random) {
  std::vector<CostAndError> points(random() % 40);
  const std::uint64_t values = 1 + random() % 12;
  for (CostAndError& p : points) p = {static_cast<double>(random() % values), static_cast<double>(random() % values)};
  return points;
}

bool is_dominated(const CostAndError& p, const std::vector<CostAndError>& points) {
  return std::any_of(points.begin(), points.end(), [&](const CostAndError& q) {
    return dominates(std::array{q.cost, q.error}, std::array{p.cost, p.error});
  });
}

TEST(Pareto, TheFrontIsWhatNothingDominates) {
  std::mt19937_64 random(1);
  int on_front = 0, off_front = 0;
  for (int round = 0; round < 500; ++round) {
    const std::vector<CostAndError> points = random_points(random);
    std::vector<int> expected;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!is_dominated(points[i], points)) expected.push_back(static_cast<int>(i));
    const std::vector<int> front = pareto_front(points);
    EXPECT_THAT(front, ::testing::UnorderedElementsAreArray(expected)) << "round " << round;
    for (std::size_t k = 1; k < front.size(); ++k) {
      EXPECT_LE(points[front[k - 1]].cost, points[front[k]].cost);
      EXPECT_GE(points[front[k - 1]].error, points[front[k]].error);
    }
    on_front += static_cast<int>(front.size());
    off_front += static_cast<int>(points.size() - front.size());
  }
  EXPECT_GT(on_front, 500); // both happen often
  EXPECT_GT(off_front, 500);
}

TEST(Pareto, OrderDoesNotMatterAndWhatIsWorseChangesNothing) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 200; ++round) {
    std::vector<CostAndError> points = random_points(random);
    if (points.empty()) continue;
    const auto values = [](const std::vector<CostAndError>& all) {
      std::vector<std::pair<double, double>> front;
      for (const int i : pareto_front(all)) front.emplace_back(all[i].cost, all[i].error);
      return front;
    };
    const auto before = values(points);
    std::shuffle(points.begin(), points.end(), random);
    EXPECT_EQ(values(points), before);
    const CostAndError any = points[random() % points.size()];
    points.push_back({any.cost + 1.0, any.error + 1.0});
    EXPECT_EQ(values(points), before);
  }
}

TEST(Pareto, DominatingIsAStrictOrder) {
  std::mt19937_64 random(3);
  const auto point = [&] {
    std::array<double, 3> p{};
    for (double& v : p) v = static_cast<double>(random() % 3);
    return p;
  };
  int dominated = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto a = point(), b = point(), c = point();
    EXPECT_FALSE(dominates(a, a));
    EXPECT_FALSE(dominates(a, b) && dominates(b, a));
    if (dominates(a, b) && dominates(b, c)) {
      EXPECT_TRUE(dominates(a, c));
    }
    dominated += dominates(a, b);
  }
  EXPECT_GT(dominated, 300);
}

TEST(Pareto, NothingHasNoFront) { EXPECT_THAT(pareto_front({}), ::testing::IsEmpty()); }

TEST(Median, IsTheMiddleOfTheSorted) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 300; ++round) {
    std::vector<double> values(1 + random() % 20);
    for (double& v : values) v = static_cast<double>(random() % 10);
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t n = sorted.size();
    EXPECT_EQ(median(values), 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]));
  }
}

/// A row of substeps, seed, outcome, cost and error.
Row row(int substeps, int seed, const std::string& outcome, double ms, double error) {
  Row r;
  r.set("key", std::to_string(100 * substeps + seed));
  r.set("substeps", std::to_string(substeps));
  r.set("seed", std::to_string(seed));
  r.set("outcome", outcome);
  r.set("recoveries", "3");
  if (ms > 0) r.set("ms_p99", ms);
  if (ms > 0) r.set("trajectory_mm_rms", error);
  return r;
}

SettingValues default_values() {
  Row r = row(12, 0, "ok", 1, 1);
  SettingValues values;
  for (const std::string& column : setting_columns()) values.push_back(r.text(column));
  return values;
}

TEST(ChartPoints, RunsOfOneSettingAreOnePoint) {
  const std::vector<Row> rows = {row(12, 0, "ok", 1.0, 4.0), row(6, 0, "ok", 0.5, 9.0), row(12, 1, "ok", 3.0, 6.0),
                                 row(12, 2, "ok", 2.0, 5.0)};
  const auto points = points_of(rows, default_values());
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].rows.size(), 3u);
  EXPECT_EQ(points[0].cost(), 1.0);
  EXPECT_EQ(points[0].figure("trajectory_mm_rms"), 5.0);
  EXPECT_EQ(points[0].figure("drape_mm_rms"), std::nullopt);
  EXPECT_EQ(points[1].name, "6 substeps");
}

TEST(ChartPoints, OneFailedRunFailsTheSettingAndKeepsItOffTheFront) {
  const std::vector<Row> rows = {row(12, 0, "ok", 1.0, 4.0), row(1, 0, "ok", 0.1, 0.1),
                                 row(1, 1, "recovered", 0.1, 0.1), row(2, 0, "crashed", 0, 0)};
  const auto points = points_of(rows, default_values());
  ASSERT_EQ(points.size(), 3u);
  EXPECT_TRUE(points[0].good());
  EXPECT_EQ(points[1].failed, 1);
  EXPECT_EQ(points[1].reason, "diverged 3 times");
  EXPECT_FALSE(points[2].good());
  EXPECT_THAT(front_of(points, error_axes().front()), ::testing::ElementsAre(0));
  EXPECT_THAT(points_text(points), ::testing::HasSubstr("FAILED 1 of 2: diverged 3 times"));
}

/// With a figure on every axis.
Row whole_row(int substeps, double ms, double trajectory, double body, double longer) {
  Row r = row(substeps, 0, "ok", ms, trajectory);
  r.set("drape_mm_rms", 5.0);
  r.set("in_body_mm_surface", body);
  r.set("longer_pct_p99", longer);
  return r;
}

TEST(ChartPoints, WhatGoesThroughTheBodyHasFailed) {
  const auto points =
      points_of({whole_row(12, 1.0, 4.0, 2.0, 0.02), whole_row(6, 0.1, 4.0, 81.0, 0.001)}, default_values());
  EXPECT_TRUE(points[0].good());
  EXPECT_EQ(points[1].reason, "81 mm in the body");
  for (const ErrorAxis& axis : error_axes())
    EXPECT_THAT(front_of(points, axis), ::testing::ElementsAre(0)) << axis.stem;
}

TEST(ChartPoints, OfSettingsThatMoveTheSameTheClockDoesNotChoose) {
  Row own = whole_row(12, 1.0, 4.0, 2.0, 0.02);
  own.set("name", "default");
  const auto verdict = [&](double ms, double trajectory) {
    return default_verdict(points_of({own, whole_row(6, ms, trajectory, 2.0, 0.02)}, default_values()));
  };
  EXPECT_THAT(verdict(0.95, 4.0), ::testing::HasSubstr("default: on the front of trajectory\n"));
  EXPECT_THAT(verdict(0.5, 4.0),
              ::testing::HasSubstr("default: not on the front of trajectory: 6 substeps has 4 in 0.500 ms"));
  EXPECT_THAT(verdict(0.95, 3.9), ::testing::HasSubstr("default: not on the front of trajectory: 6 substeps"));
}

} // namespace
