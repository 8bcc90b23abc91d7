// `tutu bench` on the scenes of stability and of formulas.
#include "rig/file_io.h"
#include "src/bench/stability_report.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include <gmock/gmock.h>

using namespace tutu;
using ::testing::HasSubstr;

namespace {

nlohmann::json figures_of(const std::vector<std::string>& arguments, int status, std::string* output = nullptr) {
  const auto folder = test::scratch_folder();
  std::vector<std::string> all = {"bench"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  all.insert(all.end(), {"--json", (folder / "figures.json").string()});
  const test::Outcome outcome = test::run_program(all);
  EXPECT_EQ(outcome.status, status) << outcome.output;
  if (output) *output = outcome.output;
  const nlohmann::json figures = nlohmann::json::parse(read_file(folder / "figures.json"));
  std::filesystem::remove_all(folder);
  return figures;
}

TEST(BenchStability, ASceneOfStabilityWritesWhatPassed) {
  std::string output;
  const nlohmann::json figures = figures_of({"teleport", "--runs", "1"}, 0, &output);
  EXPECT_THAT(output, HasSubstr("teleport, told"));
  EXPECT_EQ(figures.at("name"), "teleport");
  EXPECT_EQ(figures.at("passed"), true);
  ASSERT_EQ(figures.at("variants").size(), 2u);
  const nlohmann::json& variant = figures.at("variants").at(0);
  EXPECT_EQ(variant.at("runs"), 1);
  EXPECT_EQ(variant.at("passed"), 1);
  EXPECT_EQ(variant.at("crossings"), 0);
  for (const char* pointer :
       {"/stretch_pct/p99", "/stretch_pct/max", "/pen_mm/max", "/speed", "/recoveries", "/most_substeps", "/ms/median"})
    EXPECT_TRUE(variant.at(nlohmann::json::json_pointer(pointer)).is_number()) << pointer;
  EXPECT_EQ(variant.at("state_hash").get<std::string>().size(), 16u);
}

TEST(BenchStability, AFormulaSceneWritesItsFigures) {
  const nlohmann::json figures = figures_of({"hang"}, 0);
  EXPECT_EQ(figures.at("passed"), true);
  const nlohmann::json& elongation = figures.at("figures").at(0);
  EXPECT_NEAR(elongation.at("measured").get<double>(), elongation.at("expected").get<double>(),
              elongation.at("tolerance").get<double>());
}

TEST(BenchStability, WhatDoesNotHoldIsStatus1AndSaid) {
  // mass_spring knows no friction.
  std::string output;
  const nlohmann::json figures = figures_of({"drop", "--solver", "mass_spring", "--substeps", "60"}, 1, &output);
  EXPECT_EQ(figures.at("passed"), false);
  EXPECT_THAT(output, HasSubstr("FAIL"));
}

TEST(BenchStability, OptionsOfAnotherSceneAreRefused) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"bench", "hang", "--n", "30"},
                                                    {"bench", "hang", "--still"},
                                                    {"bench", "dancer-skirt", "--runs", "3"},
                                                    {"bench", "dancer-skirt", "--fixed-substeps"}}) {
    const test::Outcome outcome = test::run_program(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("only"));
  }
}

TEST(BenchStability, NamesAreUnique) {
  std::vector<std::string> names = app::stability_names();
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

} // namespace
