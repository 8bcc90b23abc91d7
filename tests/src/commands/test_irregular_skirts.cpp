// Skirts of irregular triangles over the whole dance: how deep any point of them is in the skinned body.
#include "tests/support/irregular_skirt.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::test;
using nlohmann::json;

namespace {

class IrregularSkirts : public ::testing::Test {
protected:
  void SetUp() override { folder_ = scratch_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Runs the program, which writes figures.
  json figures_of(std::vector<std::string> arguments) {
    const std::string file = (folder_ / "figures.json").string();
    arguments.insert(arguments.end(), {"--json", file});
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return json::parse(read_file(file));
  }

  std::filesystem::path folder_;
};

// With the clearance of her own skirt, that is for what the proxies miss of the skin. Measured like this by hand: 64 a
// side.
TEST_F(IrregularSkirts, OnProxiesStayWithin3mmOfTheSkin_slow) {
  const std::string scene = irregular_skirt(folder_, "skirt", 30, 30, 0.007);
  const json cloth = figures_of({"validate", scene, "--samples", "100", "--every", "12"})["cloth_in_body"];
  EXPECT_LE(cloth["surface_max_mm"], 3.0);
  EXPECT_LT(cloth["end"]["garments"].at(0)["longer_pct"], 30.0);
}

// Without any.
TEST_F(IrregularSkirts, OnTheBodyItselfAreNowhereInside_slow) {
  const std::string scene = irregular_skirt(folder_, "skirt", 12, 24, 0.0);
  const json figures = figures_of(
      {"play", scene, "--headless", "--no-pictures", "--frames", "12", "--backend", "mesh", "--features", "triangles"});
  EXPECT_LT(figures["surface_mm"]["body"]["max"], 0.01);
}

} // namespace
