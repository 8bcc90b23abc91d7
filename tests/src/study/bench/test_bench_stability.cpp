// `tutu bench` on the scenes of stability and of formulas.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/study/bench/convergence.h"
#include "src/study/bench/cusick.h"
#include "src/study/bench/stability_report.h"
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
       {"/through/limbs/frames", "/through/limbs/worst", "/through/itself/total", "/longer_pct/p99", "/longer_pct/max",
        "/pen_mm/max", "/surface_mm/max", "/deepest_mm", "/speed", "/recoveries", "/most_substeps", "/ms/median"})
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

TEST(BenchStability, FabricsDrapeWithinTheirPublishedBands_slow) {
  std::string output;
  const nlohmann::json figures = figures_of({"cusick"}, 0, &output);
  ASSERT_EQ(figures.at("figures").size(), 4u);
  for (const char* fabric : {"silk, published 20 to 40 %", "cotton, published 60 to 76 %", "wool, published 40 to 70 %",
                             "denim, published 70 to 90 %"})
    EXPECT_THAT(output, HasSubstr(fabric));
}

TEST(BenchStability, AFabricWithoutABandIsMeasuredOnly) {
  const auto folder = test::scratch_folder();
  write_file(folder / "rag.json", R"({"density": 0.1, "bend": 0})");
  app::RunSettings setup;
  setup.solver = cloth::SolverKind::mass_spring;
  const std::vector<app::AnalyticFigure> figures = app::cusick(folder, setup);
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_THAT(figures[0].what, HasSubstr("rag, no published band"));
  EXPECT_THROW(app::cusick(folder / "nowhere", setup), InputError);
  std::filesystem::remove_all(folder);
}

TEST(BenchStability, TheErrorInTheStepIsOfFirstOrder) {
  for (const cloth::SolverKind kind : {cloth::SolverKind::mass_spring, cloth::SolverKind::xpbd}) {
    app::RunSettings setup;
    setup.solver = kind;
    const std::vector<app::AnalyticFigure> figures = app::convergence_in_step(setup);
    EXPECT_NEAR(figures.back().measured, 1.0, 0.15) << cloth::name_of(kind);
  }
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
                                                    {"bench", "dancer-skirt", "--no-adaptive-substeps"}}) {
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
