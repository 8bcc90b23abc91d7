#include "rig/io/file_io.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tutu::test {
namespace {

using ::testing::HasSubstr;

std::string dancer() { return source_file("assets/characters/dancer.dae").string(); }

TEST(FitCommand, WritesProxiesThatMeetTheirNote_slow) {
  const auto folder = scratch_folder();
  const std::string out = (folder / "p.json").string(), json = (folder / "f.json").string();
  const Outcome fit = run_program({"fit", dancer(), "--count", "16", "--out", out, "--json", json});
  ASSERT_EQ(fit.status, 0) << fit.output;
  const auto figures = nlohmann::json::parse(read_file(json)), proxies = nlohmann::json::parse(read_file(out));
  EXPECT_EQ(figures["count"], 16);
  EXPECT_EQ(proxies["proxies"].size(), 16u);
  EXPECT_LT(figures["under_mm"]["p95"], 20.0);
  EXPECT_LT(figures["over_mm"]["p95"], 20.0);
  EXPECT_GE(figures["under_mm"]["bound"], figures["under_mm"]["max"]);
  EXPECT_NEAR(proxies["fit"]["under_mm"]["p95"].get<double>(), figures["under_mm"]["p95"].get<double>(), 0.01);
  EXPECT_GE(figures["curve"].size(), 3u);
}

TEST(FitCommand, TwoRadiiMissByLess_slow) {
  const auto folder = scratch_folder();
  const auto figures_of = [&](const std::string& kind) {
    const std::string out = (folder / (kind + ".json")).string(), json = (folder / "f.json").string();
    const Outcome fit = run_program({"fit", dancer(), "--count", "20", "--kind", kind, "--out", out, "--json", json});
    EXPECT_EQ(fit.status, 0) << fit.output;
    return nlohmann::json::parse(read_file(json));
  };
  const auto plain = figures_of("capsule"), tapered = figures_of("tapered");
  for (const char* side : {"under_mm", "over_mm"})
    EXPECT_LT(tapered[side]["rms"].get<double>(), plain[side]["rms"].get<double>()) << side;
  const auto proxies = nlohmann::json::parse(read_file(folder / "tapered.json"));
  EXPECT_TRUE(std::any_of(proxies["proxies"].begin(), proxies["proxies"].end(), [](const auto& proxy) {
    return proxy.contains("capsule") && proxy["capsule"]["radius"].is_array();
  }));
}

TEST(FitCommand, LeavesOutWhatNoGarmentReaches_slow) {
  const auto folder = scratch_folder();
  const std::string json = (folder / "f.json").string();
  const Outcome fit =
      run_program({"fit", dancer(), "--count", "16", "--motion", source_file("assets/poses/walk.json").string(),
                   "--for", source_file("assets/garments/top.json").string(), "--json", json});
  ASSERT_EQ(fit.status, 0) << fit.output;
  const auto figures = nlohmann::json::parse(read_file(json));
  EXPECT_EQ(figures["reach"].size(), 16u);
  EXPECT_LT(figures["count"], 16); // a top never meets her feet
  EXPECT_THAT(fit.output, HasSubstr("left out: "));
}

TEST(FitCommand, SaysWhatIsWrong) {
  const auto refuses = [](std::vector<std::string> arguments, const std::string& words) {
    arguments.insert(arguments.begin(), "fit");
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(words));
  };
  refuses({dancer(), "--count", "0"}, "count");
  refuses({dancer(), "--kind", "box"}, "--kind");
  refuses({dancer(), "--max-error-mm", "nan"}, "finite");
  refuses({dancer(), "--for", "nowhere.json"}, "nowhere.json");
  refuses({dancer(), "--curve", "curve.pdf"}, ".svg or .png");
  refuses({"nobody.dae"}, "nobody.dae");
  refuses({assimp_model("X/BCN_Epileptic.X").string(), "--motion", source_file("assets/poses/dance.json").string()},
          "joint");
}

TEST(FitCommand, SaysSoWithoutGnuplot) {
  const Outcome outcome = run_program({"fit", dancer(), "--curve", "curve.svg"}, "PATH=/nowhere");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.output, HasSubstr("gnuplot"));
}

} // namespace
} // namespace tutu::test
