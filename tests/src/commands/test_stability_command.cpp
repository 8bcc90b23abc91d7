// `tutu stability`, and the warning of `tutu play`, as a user meets them.
#include "rig/io/file_io.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

TEST(StabilityCommand, WritesMapsAndAllTheirCells_slow) {
  const auto folder = test::scratch_folder();
  const test::Outcome outcome =
      test::run_program({"stability", "--quick", "--starts", "1", "--only", "step-cells-mass_spring,cells-radius",
                         "--json", (folder / "maps.json").string(), "-o", (folder / "maps").string()});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json json = nlohmann::json::parse(read_file(folder / "maps.json"));
  ASSERT_EQ(json.at("maps").size(), 3u); // cells-radius and its bare twin
  const nlohmann::json& steps = json.at("maps").at(0);
  EXPECT_EQ(steps.at("name"), "step-cells-mass_spring");
  EXPECT_EQ(steps.at("own_method"), false);
  EXPECT_EQ(steps.at("cells").size(), 35u); // 5 sizes, 7 steps
  EXPECT_EQ(steps.at("bound").at("y").size(), 5u);
  EXPECT_EQ(steps.at("margin").at("holds"), false) << "12 substeps are too few for it";
  int failed = 0;
  for (const nlohmann::json& cell : steps.at("cells")) failed += cell.at("outcomes").at("held") == 0;
  EXPECT_GT(failed, 5);
  EXPECT_LT(failed, 30);
  for (const char* name : {"step-cells-mass_spring.svg", "cells-radius.png", "cells-radius-bare.svg", "cells.csv"})
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / "maps" / name)) << name;
  EXPECT_THAT(outcome.output, HasSubstr("cells-radius "));
  std::filesystem::remove_all(folder);
}

TEST(StabilityCommand, ASettingThatFailsIsStatus1_slow) {
  const auto folder = test::scratch_folder();
  const test::Outcome outcome =
      test::run_program({"stability", "--solver", "mass_spring", "--substeps", "5", "--quick", "--starts", "1",
                         "--only", "step-stiffness-mass", "--no-pictures", "-o", folder.string()});
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("FAILS"));
  std::filesystem::remove_all(folder);
}

TEST(StabilityCommand, BadInputIsOneMessageAndStatus2) {
  const auto folder = test::scratch_folder();
  write_file(folder / "taken", "");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"stability", "--only", "no-such-map", "--no-pictures", "-o", folder.string()},
        {"stability", "--no-pictures", "-o", (folder / "taken").string()},
        {"stability", (folder / "none.json").string()},
        {"stability", "--starts", "0"}}) {
    const test::Outcome outcome = test::run_program(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, Not(HasSubstr("terminate")));
  }
  std::filesystem::remove_all(folder);
}

TEST(StabilityCommand, PlayWarnsOnceOfAStepThatCannotHold_slow) {
  const std::vector<std::string> play = {"play", "--headless", "--no-pictures", "--frames", "1"};
  std::vector<std::string> broken = play;
  broken.insert(broken.end(), {"--solver", "mass_spring", "--substeps", "5"});
  const std::string told = test::run_program(broken).output;
  EXPECT_THAT(told, HasSubstr("warning: outside of what is safe"));
  EXPECT_THAT(told, HasSubstr("substeps a frame or more"));
  EXPECT_EQ(told.find("warning"), told.rfind("warning"));
  EXPECT_THAT(test::run_program(play).output, Not(HasSubstr("warning")));
}

} // namespace
