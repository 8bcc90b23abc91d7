// tutu chart and tutu cell as a user meets them, on a scene that runs in a moment.
#include "rig/io/file_io.h"
#include "src/study/chart/results_file.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

namespace fs = std::filesystem;

class ChartCommand : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = scratch_folder();
    scene_ = write_small_scene(folder_);
    out_ = folder_ / "out";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<std::string> on_scene(const std::string& command, const std::vector<std::string>& more) const {
    std::vector<std::string> words = {command,
                                      scene_,
                                      "--frames",
                                      "12",
                                      "--settle",
                                      "4",
                                      "--held",
                                      "4",
                                      "--every",
                                      "2",
                                      "--cache",
                                      (folder_ / "cache").string(),
                                      "--reference-substeps",
                                      "4,8,16"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Outcome chart(const std::string& settings, const std::vector<std::string>& more = {}) {
    write_file(folder_ / "settings.json", settings);
    std::vector<std::string> words = {
        "--settings", (folder_ / "settings.json").string(), "-o", out_.string(), "--repeats", "2", "--jobs", "2"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(on_scene("chart", words));
  }
  std::map<std::string, Row> rows_by_name(const std::string& seed = "1") const {
    std::map<std::string, Row> rows;
    for (const Row& row : read_results(out_ / "results.csv").rows)
      if (row.text("seed") == seed) rows.emplace(row.text("name"), row);
    return rows;
  }

  fs::path folder_, out_;
  std::string scene_;
};

constexpr const char* k_settings = R"({"settings": [
  {"name": "no proxies", "proxies": "none"},
  {"name": "broken", "solver": "mass_spring", "substeps": 1, "adaptive_substeps": false}]})";

TEST_F(ChartCommand, WhatIsBrokenOrMissingShows) {
  const Outcome outcome = chart(k_settings);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("reference,    4 to    8 substeps"), HasSubstr("8 to   16 substeps"),
                                    HasSubstr("default: "), HasSubstr("FAILED 2 of 2")));
  const auto rows = rows_by_name();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows.at("default").text("outcome"), "ok");
  EXPECT_NE(rows.at("broken").text("outcome"), "ok");
  EXPECT_THAT(rows.at("broken").text("reason"), HasSubstr("diverged"));
  const auto figure = [&](const char* name, const char* column) { return rows.at(name).number(column).value_or(-1); };
  EXPECT_LT(figure("default", "in_body_mm_max"), 1.0);
  EXPECT_GT(figure("no proxies", "in_body_mm_max"), 5.0);
  EXPECT_GT(figure("no proxies", "missed_contacts"), 0.9);
  EXPECT_GT(figure("no proxies", "trajectory_mm_rms"), 3.0 * figure("default", "trajectory_mm_rms"));
  for (const char* column : {"ms_p99", "ms_median", "cloth_ms_p99", "contact_ms_median", "longer_pct_p99",
                             "drape_mm_rms", "drape_mm_hausdorff", "jitter", "energy_drift_mj", "false_contacts"})
    EXPECT_GE(figure("default", column), 0.0) << column;
  EXPECT_THAT(rows.at("default").text("machine"), Not(::testing::IsEmpty()));

  for (const char* stem : {"trajectory", "drape", "body", "longer"}) {
    EXPECT_THAT(read_file(out_ / fmt::format("chart-{}.png", stem)), ::testing::StartsWith("\x89PNG"));
    const std::string svg = read_file(out_ / fmt::format("chart-{}.svg", stem));
    EXPECT_THAT(svg, AllOf(HasSubstr("default"), HasSubstr("broken: diverged"), HasSubstr("Pareto front")));
  }
  const std::string page = read_file(out_ / "chart.html");
  EXPECT_THAT(page, AllOf(::testing::StartsWith("<!doctype html>"), ::testing::EndsWith("</html>\n")));
  EXPECT_THAT(page, AllOf(HasSubstr("tutu cell "), HasSubstr("--proxies none"), HasSubstr("no proxies")));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("src=")), Not(HasSubstr("href=")))); // nothing from elsewhere
}

TEST_F(ChartCommand, GoesOnWithTheRowsThatAreThere) {
  ASSERT_EQ(chart(k_settings).status, 0);
  const std::string whole = read_file(out_ / "results.csv");
  EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 1 + 2 * 3);
  const Outcome again = chart(k_settings);
  EXPECT_THAT(again.output, HasSubstr("6 of 6 runs are in "));
  EXPECT_EQ(read_file(out_ / "results.csv"), whole);

  write_file(out_ / "results.csv", whole.substr(0, whole.size() - 30)); // the machine crashed while it wrote
  const Outcome after = chart(k_settings);
  EXPECT_EQ(after.status, 0) << after.output;
  EXPECT_THAT(after.output, AllOf(HasSubstr("line 7: found a row cut off"), HasSubstr("5 of 6 runs are in ")));
  const std::string mended = read_file(out_ / "results.csv");
  const std::size_t kept = whole.rfind('\n', whole.size() - 2) + 1;
  EXPECT_EQ(mended.substr(0, kept), whole.substr(0, kept));
  EXPECT_EQ(std::count(mended.begin(), mended.end(), '\n'), 1 + 2 * 3);
}

TEST_F(ChartCommand, ACellGivesTheSameRowAgain) {
  const std::vector<std::string> words = on_scene("cell", {"--substeps", "3", "--seed", "1"});
  const auto hash = [](const std::string& output) { return output.substr(output.find("state_hash"), 40); };
  const Outcome first = run_program(words), second = run_program(words);
  EXPECT_EQ(first.status, 0) << first.output;
  EXPECT_THAT(first.output, AllOf(HasSubstr("substeps              3\n"), HasSubstr("trajectory_mm_rms")));
  EXPECT_EQ(hash(first.output), hash(second.output));
  EXPECT_NE(hash(first.output), hash(run_program(on_scene("cell", {"--substeps", "3", "--seed", "2"})).output));
}

TEST_F(ChartCommand, InputThatCannotBeIsStatus2) {
  const auto expect_refused = [](const Outcome& outcome, const ::testing::Matcher<std::string>& message) {
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, message);
  };
  expect_refused(chart(R"({"settings": []})"), HasSubstr("/settings: found an empty grid of settings"));
  expect_refused(chart(R"({"settings": [{"frames_per_second": 7}]})"), HasSubstr("frames_per_second: found 7"));
  expect_refused(chart(k_settings, {"--reference-substeps", "4,8"}), HasSubstr("--reference-substeps: found"));
  EXPECT_FALSE(fs::exists(out_ / "results.csv"));

  ASSERT_EQ(run_program(on_scene("cell", {})).status, 0);
  const fs::path mine = *fs::directory_iterator(folder_ / "cache");
  scene_ = write_small_scene(folder_, "other", 0.3);
  expect_refused(run_program(on_scene("cell", {"--reference", mine.string()})),
                 AllOf(HasSubstr("/fingerprint: found a reference of small"), HasSubstr("expected that of other")));
  write_file(mine, "{\"scene\": ");
  expect_refused(run_program(on_scene("cell", {"--reference", mine.string()})), HasSubstr("line 1"));
  expect_refused(run_program(on_scene("cell", {"--proxies", (folder_ / "none.json").string()})),
                 HasSubstr("none.json"));
}

} // namespace
