// What the program says of how a run began and ended, whatever its exit status.
#include "rig/io/file_io.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::test;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

namespace {

class RunEndCommand : public ::testing::Test {
protected:
  void SetUp() override { scene_ = write_small_scene(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Writes the sheet anew: level at `height`, held along both ends of its rows.
  void wear(double height, double stretch) {
    write_file(
        folder_ / "sheet.json",
        fmt::format(R"({{"name": "sheet", "shape": {{"grid": {{"rows": 9, "columns": 9, "corner": [-0.2, {}, -0.2],
      "across": [0.4, 0, 0], "down": [0, 0, 0.4]}}}}, "fabric": {{"density": 0.2, "stretch": {}, "drag": 1}},
      "attachments": [{{"joint": "Hips", "rows": 0}}, {{"joint": "Hips", "rows": -1}}]}})",
                    height, stretch));
  }
  json play(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"play", scene_, "--headless", "--no-pictures", "--json", figures_.string()};
    words.insert(words.end(), more.begin(), more.end());
    outcome_ = run_program(words);
    EXPECT_EQ(outcome_.status, 0) << outcome_.output;
    return json::parse(read_file(figures_));
  }
  std::string last_line() const {
    const std::string text = outcome_.output.substr(0, outcome_.output.size() - 1);
    return text.substr(text.rfind('\n') + 1);
  }

  std::filesystem::path folder_ = scratch_folder(), figures_ = folder_ / "figures.json";
  std::string scene_;
  Outcome outcome_;
};

TEST_F(RunEndCommand, WhatIsWellEndsWithoutAWord) {
  const json figures = play();
  EXPECT_THAT(outcome_.output, Not(HasSubstr("warning")));
  EXPECT_EQ(figures["end"]["warning"], nullptr);
  const json& end = figures["end"]["garments"].at(0);
  EXPECT_EQ(end["garment"], "sheet");
  for (const char* in : {"proxies", "body"}) {
    EXPECT_GE(end["surface_mm"][in], 0.0);
    EXPECT_LT(end["surface_mm"][in], 20.0);
  }
  for (const char* figure : {"longer_pct", "shorter_pct", "held_longer_pct"})
    for (const char* of : {"max", "p99", "mean"}) EXPECT_TRUE(figures[figure][of].is_number()) << figure;
  EXPECT_GE(figures["surface_mm"]["proxies"]["max"], figures["penetration_mm"]["proxies"]["max"]);
}

TEST_F(RunEndCommand, ClothInTheBodyIsToldWhateverTheProxiesSay) {
  // Through the middle of the trunk, of which the proxies know a thread: off its axis by the thread and 2 mm of cloth,
  // 117 mm deep in a round of 120 mm; the skin has 24 sides, and is up to 1 mm nearer; falling, the cloth leaves the
  // axis by 1 or 2 mm more.
  wear(0.5, 300);
  write_file(folder_ / "proxies.json", proxies_json({{{0, 0.3, 0}, {0, 0.7, 0}, 0.001}}));
  const json figures = play({"--frames", "3"});
  EXPECT_THAT(last_line(), StartsWith("tutu: warning: sheet ends with its surface 1"));
  EXPECT_THAT(last_line(), HasSubstr(" mm deep in the body (by particle 40)"));
  EXPECT_NEAR(figures["end"]["garments"].at(0)["surface_mm"]["body"], 115.5, 1.5);
  EXPECT_LT(figures["end"]["garments"].at(0)["surface_mm"]["proxies"], 2.0);

  outcome_ = run_program({"validate", scene_, "--json", figures_.string(), "--samples", "200", "--every", "6"});
  EXPECT_EQ(outcome_.status, 0) << outcome_.output;
  EXPECT_THAT(last_line(), StartsWith("tutu: warning: sheet ends with its surface 1"));
  const json cloth = json::parse(read_file(figures_))["cloth_in_body"];
  EXPECT_NEAR(cloth["surface_max_mm"], 115.5, 1.5);
  EXPECT_EQ("tutu: warning: " + cloth["end"]["warning"].get<std::string>(), last_line());
}

TEST_F(RunEndCommand, ThreadsTwiceAsLongAreTold) {
  wear(1.5, 0.05); // above the body; its own weight is too much for it
  const json figures = play({"--frames", "3"});
  EXPECT_THAT(last_line(), StartsWith("tutu: warning: sheet ends with a thread "));
  EXPECT_THAT(last_line(), HasSubstr(" % longer than at rest (particles "));
  const json& end = figures["end"]["garments"].at(0);
  EXPECT_GT(end["longer_pct"], 100.0);
  EXPECT_GE(figures["longer_pct"]["max"], end["longer_pct"]);
  EXPECT_LT(figures["held_longer_pct"]["max"], 1e-9) << "pins are where they were";
}

TEST_F(RunEndCommand, AnUnevenStartIsStatedAndIsTheSeedsAlone) {
  ASSERT_EQ(run_program({"drape", scene_}).status, 0);
  const json even = play();
  EXPECT_EQ(even["uneven_mm"], 0.0);
  EXPECT_EQ(even["seed"], nullptr) << "nothing is random";
  const json first = play({"--uneven-mm", "0.1", "--seed", "3"});
  EXPECT_EQ(first["uneven_mm"], 0.1);
  EXPECT_EQ(first["seed"], 3);
  EXPECT_THAT(outcome_.output, HasSubstr("start uneven by 0.1 mm, seed 3\n"));
  EXPECT_THAT(outcome_.output, Not(HasSubstr("draping anew"))) << "a drape is even";
  EXPECT_NE(first["state_hash"], even["state_hash"]);
  EXPECT_EQ(first["state_hash"], play({"--uneven-mm", "0.1", "--seed", "3", "--threads", "2"})["state_hash"]);
  EXPECT_NE(first["state_hash"], play({"--uneven-mm", "0.1", "--seed", "4"})["state_hash"]);

  json scene = json::parse(read_file(scene_));
  scene["solver"].update({{"uneven_mm", 0.1}, {"seed", 3}});
  write_file(scene_, scene.dump());
  EXPECT_EQ(play()["state_hash"], first["state_hash"]);
}

} // namespace
