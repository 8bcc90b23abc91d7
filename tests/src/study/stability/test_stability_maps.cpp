// Maps of stability: how they are run, read and written.
#include "src/study/stability/map_files.h"
#include "src/study/stability/margin.h"
#include "src/study/stability/step_bound.h"
#include "src/study/stability/trials.h"
#include "src/study/stability/warning.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::app;
using ::testing::HasSubstr;

namespace {

/// Fails where x y > 10: with one start of each, with the others from 20 on.
StabilityMap made_up_map() {
  StabilityMap map{"made-up",
                   "Made up",
                   "nothing was run",
                   {"speed", "m/s", 1.0, {1, 2, 4, 8}, 2.0},
                   {"gap", "mm", 1e3, {0.001, 0.002, 0.004}, 0.002}};
  map.own_method = true;
  map.run = [](double x, double y, std::uint64_t seed, MapCell& cell) {
    const bool fails = x * 1e3 * y > (seed == 1 ? 10.0 : 20.0);
    ++cell.outcomes[index_of(fails ? Outcome::tunnelled : Outcome::held)];
  };
  return map;
}

StabilityMap run_made_up(int threads = 1) {
  std::vector<StabilityMap> maps = {made_up_map()};
  EXPECT_TRUE(run_maps(maps, {false, 3, threads}, [](int, int) { return true; }));
  return maps.front();
}

TEST(StabilityMaps, EveryCellIsRunFromEveryStart) {
  const StabilityMap map = run_made_up();
  ASSERT_EQ(map.cells.size(), 12u);
  for (const MapCell& cell : map.cells) EXPECT_EQ(cell.starts, 3);
  EXPECT_EQ(map.cell(0, 0).failed(), 0);
  EXPECT_EQ(map.cell(2, 2).failed(), 1); // 16
  EXPECT_EQ(map.cell(3, 2).failed(), 3); // 32
  EXPECT_EQ(map.cell(3, 2).worst(), Outcome::tunnelled);
}

TEST(StabilityMaps, ThreadsChangeNothing) {
  const std::vector<StabilityMap> one = {run_made_up(1)}, two = {run_made_up(2)};
  EXPECT_EQ(maps_csv(one), maps_csv(two));
}

TEST(StabilityMaps, ProgressCountsStartsAndStops) {
  std::vector<StabilityMap> maps = {made_up_map()};
  int last = 0;
  EXPECT_FALSE(run_maps(maps, {false, 3, 1}, [&](int done, int total) {
    EXPECT_EQ(done, last + 1);
    EXPECT_EQ(total, 36);
    last = done;
    return done < 7;
  }));
  EXPECT_EQ(last, 7);
}

TEST(StabilityMaps, PlacesAreBetweenLogarithms) {
  const MapAxis axis{"x", "", 1.0, {1, 2, 4}, {}};
  EXPECT_DOUBLE_EQ(axis.place(1).value(), 0.0);
  EXPECT_DOUBLE_EQ(axis.place(4).value(), 2.0);
  EXPECT_NEAR(axis.place(2 * std::sqrt(2)).value(), 1.5, 1e-12);
  EXPECT_NEAR(axis.place(5).value(), 2.32, 0.01);
  EXPECT_FALSE(axis.place(6).has_value());
  EXPECT_FALSE(axis.place(0).has_value());
  EXPECT_FALSE(axis.place(std::nan("")).has_value());
}

TEST(StabilityMaps, TheMarginIsTheNearestFailureOnEitherAxis) {
  // Its own cell is (2, 0.002); along speed 8 * 2 = 16 fails, along the gap 2 * 4 = 8 holds.
  const StabilityMap map = run_made_up();
  const std::optional<Margin> margin = margin_of(map, 1e-3);
  ASSERT_TRUE(margin && margin->holds && margin->nearest);
  EXPECT_TRUE(margin->nearest->along_x);
  EXPECT_DOUBLE_EQ(margin->nearest->ratio, 4.0);
  const std::string words = in_words(map, 1e-3);
  EXPECT_THAT(words,
              HasSubstr("holds; the nearest failure is at speed 8 m/s, 4 times above its own 2 m/s (tunnelled)"));
}

TEST(StabilityMaps, ASceneThatFailsItselfIsTold) {
  std::vector<StabilityMap> maps = {made_up_map()};
  maps[0].x.own = 8.0;
  maps[0].y.own = 0.004;
  run_maps(maps, {false, 2, 1}, [](int, int) { return true; });
  EXPECT_FALSE(margin_of(maps[0], 1e-3)->holds);
  EXPECT_THAT(in_words(maps[0], 1e-3), HasSubstr("FAILS at its own place: 2 of 2 starts, mostly tunnelled"));
  maps[0].x.own = 100.0;
  EXPECT_FALSE(margin_of(maps[0], 1e-3).has_value());
}

TEST(StabilityMaps, AMapOfStepsComparesTheScenesOwn) {
  StabilityMap map = run_made_up();
  map.of_steps = true;
  for (MapCell& cell : map.cells) cell.largest_step = 2e-3;
  EXPECT_TRUE(margin_of(map, 1e-3)->holds);
  EXPECT_THAT(in_words(map, 1e-3), HasSubstr("2 times below"));
  EXPECT_FALSE(margin_of(map, 4e-3)->holds);
  EXPECT_THAT(in_words(map, 4e-3), HasSubstr("2 times above"));
}

TEST(StabilityMaps, ADeliberatelyBrokenSettingFails) {
  Patch patch;
  patch.fabric.stretch = 1000.0;
  patch.solver.solver = cloth::SolverKind::mass_spring;
  const double bound = largest_stable_step(garment_of(patch));
  StabilityMap map{
      "broken", "", "", {"stretch", "", 1.0, {500, 1000, 2000}, {}}, {"step", "", 1.0, {0.5 * bound, 3.0 * bound}, {}}};
  map.run = [&](double stretch, double step, std::uint64_t seed, MapCell& cell) {
    Patch at = patch;
    at.fabric.stretch = stretch;
    at.step = step;
    ++cell.outcomes[index_of(hang(at, seed))];
  };
  std::vector<StabilityMap> maps = {map};
  run_maps(maps, {true, 2, 1}, [](int, int) { return true; });
  for (std::size_t ix = 0; ix < 3; ++ix) {
    EXPECT_EQ(maps[0].cell(ix, 0).failed(), 0) << ix;
    EXPECT_EQ(maps[0].cell(ix, 1).failed(), 2) << ix;
  }
  EXPECT_EQ(maps[0].cell(1, 1).worst(), Outcome::diverged);
}

TEST(StabilityMaps, AStageOutcomeNamesWhatIsWrong) {
  StabilityScene scene;
  StabilityRun run;
  EXPECT_EQ(outcome_of(scene, run), Outcome::held);
  run.speed = 2.0;
  EXPECT_EQ(outcome_of(scene, run), Outcome::unsettled);
  run.longer_p99 = std::nan("");
  EXPECT_EQ(outcome_of(scene, run), Outcome::stretched);
  run.crossings = 1;
  EXPECT_EQ(outcome_of(scene, run), Outcome::tunnelled);
  run.failure = "diverged";
  EXPECT_EQ(outcome_of(scene, run), Outcome::diverged);
}

TEST(StabilityMaps, TheTableHasALineACell) {
  const std::string csv = maps_csv({run_made_up()});
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 13);
  EXPECT_THAT(csv, HasSubstr("made-up,\"speed\",m/s,8,\"gap\",mm,4,3,0,0,0,3,0,\n"));
}

TEST(StabilityMaps, ACellsTextTellsWhatItsColourTells) {
  const CellChart chart = chart_of(run_made_up(), {});
  ASSERT_EQ(chart.cells.size(), 12u);
  EXPECT_EQ(chart.cells[0].text, "");
  EXPECT_EQ(chart.cells[10].text, "T 1/3");
  EXPECT_EQ(chart.cells[11].text, "T") << "all of them";
  EXPECT_NE(chart.cells[10].colour, chart.cells[11].colour) << "one of three is paler than all";
  ASSERT_EQ(chart.marks.size(), 1u);
  EXPECT_DOUBLE_EQ(chart.marks[0].x, 1.0);
}

// ---- what play warns of

struct Warned {
  RunSettings settings;
  SceneSetting setting;

  Warned() {
    GarmentSetting garment;
    garment.name = "skirt";
    garment.step_limit = 5e-4;
    garment.gap = 0.002;
    garment.largest_cell = 0.05;
    setting.step = 1.0 / 600.0;
    setting.garments = {garment};
    setting.proxies = {{"hand", 0.04, 3.0}, {"head", 0.1, 2.0}};
  }
  std::vector<std::string> outside() const { return outside_safe_region(settings, setting); }
};

TEST(StabilityWarning, AGoodSceneHasNone) { EXPECT_TRUE(Warned().outside().empty()); }

TEST(StabilityWarning, AStepBeyondTheBoundSaysHowManySubsteps) {
  Warned scene;
  scene.settings.solver = cloth::SolverKind::mass_spring;
  ASSERT_EQ(scene.outside().size(), 1u);
  EXPECT_THAT(scene.outside()[0], HasSubstr("34 substeps")); // 1 / (60 * 0.0005)
}

TEST(StabilityWarning, AProxyThatIsTooFastForFixedSubsteps) {
  Warned scene;
  scene.setting.proxies[0].speed = 40.0; // 67 mm a substep, 42 are safe
  EXPECT_TRUE(scene.outside().empty()) << "substeps adapt";
  scene.settings.adaptive_substeps = false;
  ASSERT_EQ(scene.outside().size(), 1u);
  EXPECT_THAT(scene.outside()[0], HasSubstr("hand goes up to 40 m/s"));
  EXPECT_THAT(scene.outside()[0], HasSubstr("16 substeps"));
}

TEST(StabilityWarning, CellsThatAProxyFitsThrough) {
  Warned scene;
  scene.setting.garments[0].largest_cell = 0.08; // sqrt(2) * 42 mm are safe
  EXPECT_TRUE(scene.outside().empty()) << "triangles are asked";
  scene.setting.garments[0].only_particles = true;
  ASSERT_EQ(scene.outside().size(), 1u);
  EXPECT_THAT(scene.outside()[0], HasSubstr("59.4 mm or less"));
}

} // namespace
