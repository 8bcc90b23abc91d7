// What the program takes although it is not quite as it should be, and that it says so; rates with fractions.
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tutu::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class TolerantInput : public ::testing::Test {
protected:
  void SetUp() override { scene_ = write_small_scene(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// The small scene with these members changed.
  std::string scene(const json& changes) {
    json all = json::parse(read_file(scene_));
    all.update(changes);
    write_file(folder_ / "changed.json", all.dump());
    return (folder_ / "changed.json").string();
  }
  static Outcome play(const std::string& scene, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"play", scene, "--no-pictures", "--frames", "3"});
    return run_program(more);
  }
  void turn_some_triangles() {
    CapsuleBody body;
    body.add(k_small_trunk, 24, 6, 6);
    for (const std::size_t t : {3u, 100u, 101u, 250u}) std::swap(body.triangles[t][1], body.triangles[t][2]);
    write_capsule_character(folder_ / "body.dae", body, {0, 0.5, 0});
  }

  std::filesystem::path folder_ = scratch_folder();
  std::string scene_;
};

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(TolerantInput, RotationsOffUnitLengthPlayWithOneNote) {
  write_file(folder_ / "t.txt", "0 0 0 0.3 0 0\n0 0 0 0.3 0 0\n");
  write_file(folder_ / "q.txt", "0 0 0 1 0 0 0 1\n0 0 0 0.98 0 0 0 1\n");
  write_file(folder_ / "k.txt", "0 0.2");
  const Outcome texts =
      play(scene({{"motion", {{"texts", {{"translations", "t.txt"}, {"rotations", "q.txt"}, {"times", "k.txt"}}}}}}));
  EXPECT_EQ(texts.status, 0) << texts.output;
  EXPECT_THAT(texts.output, HasSubstr("q.txt: 1 of 4 rotations was not of unit length (0.98): normalised"));
  EXPECT_EQ(count_of(texts.output, "unit length"), 1) << texts.output;

  write_file(folder_ / "off.json", R"({"keys": [{"time": 0, "joints": {"Hips": {"rotation": [0, 0, 0, 0.98]}}},
                                                {"time": 0.2, "joints": {"Hips": {"rotation": [0, 0, 0, 1.07]}}}]})");
  const Outcome clip = play(scene({{"motion", "off.json"}}));
  EXPECT_EQ(clip.status, 0) << clip.output;
  EXPECT_THAT(clip.output, HasSubstr("note: " + (folder_ / "off.json").string() +
                                     ": 2 of 2 rotations were not of unit length (the farthest 1.07): normalised"));

  write_file(folder_ / "q.txt", "0 0 0 1 0 0 0 1\n0 0 0 0.5 0 0 0 1\n");
  const Outcome refused =
      play(scene({{"motion", {{"texts", {{"translations", "t.txt"}, {"rotations", "q.txt"}, {"times", "k.txt"}}}}}}));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.output, HasSubstr("q.txt: line 2: found a rotation of length 0.5"));
}

TEST_F(TolerantInput, WhatATakeDoesNotSayIsNoted) {
  write_file(folder_ / "take.bvh", "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
                                   "Zrotation Xrotation Yrotation\nEnd site\n{\nOFFSET 0 1 0\n}\n}\nROOT A prop\n{\n"
                                   "OFFSET 0 0 0\nCHANNELS 1 Xposition\n}\nMOTION\nFrames:2\nFrame Time:0.1\n"
                                   "0 0 0 0 0 0 7\n0 0 0 0 9 0 8\n");
  const Outcome outcome = play(scene({{"motion", {{"bvh", "take.bvh"}}}}));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("note: take.bvh: 2 roots: Hips is read; left out: A prop\n"));
}

TEST_F(TolerantInput, RatesMayHaveFractions) {
  for (const char* rate : {"29.97", "23.976", "59.94"}) {
    const Outcome option = play(scene_, {"--frames-per-second", rate}),
                  stated = play(scene({{"solver", {{"frames_per_second", std::stod(rate)}, {"substeps", 8}}}}));
    EXPECT_EQ(option.status, 0) << option.output;
    EXPECT_EQ(stated.status, 0) << stated.output;
  }
  for (const char* rate : {"0", "-29.97", "nan", "1e9", "1000000000", "0.5", "29,97"}) {
    const Outcome outcome = play(scene_, {std::string("--frames-per-second=") + rate});
    EXPECT_EQ(outcome.status, 2) << rate << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(std::string("found ") + rate + ", expected from 1 to 10000"));
  }
  for (const char* rate : {"0", "-29.97", "1e9", "\"30\"", "null"}) {
    const Outcome outcome = play(scene({{"solver", {{"frames_per_second", json::parse(rate)}}}}));
    EXPECT_EQ(outcome.status, 2) << rate << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("/solver/frames_per_second: found "));
    EXPECT_THAT(outcome.output, HasSubstr("expected a number from 1"));
    EXPECT_EQ(count_of(outcome.output, "\n"), 1) << outcome.output;
  }
}

TEST_F(TolerantInput, AChartOfARateWithFractionsComparesAtTheSameMoments) {
  const std::string at_2997 = scene({{"solver", {{"frames_per_second", 29.97}, {"substeps", 4}}}});
  write_file(folder_ / "grid.json", R"({"settings": [{"substeps": 2}, {"frames_per_second": 59.94}]})");
  const Outcome chart = run_program({"chart", at_2997, "--settings", (folder_ / "grid.json").string(), "--out",
                                     (folder_ / "chart").string(), "--frames", "4", "--settle", "2", "--held", "2",
                                     "--every", "1", "--reference-substeps", "4,8,16"});
  EXPECT_EQ(chart.status, 0) << chart.output;
  std::string csv;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "chart"))
    if (entry.path().extension() == ".csv") csv += read_file(entry.path());
  EXPECT_THAT(csv, HasSubstr(",29.97,"));
  EXPECT_THAT(csv, HasSubstr(",59.94,"));
  const Outcome odd = run_program({"cell", at_2997, "--frames-per-second", "60"});
  EXPECT_EQ(odd.status, 2) << odd.output;
  EXPECT_THAT(odd.output, HasSubstr("frames of 29.97 a second are whole frames"));
}

TEST_F(TolerantInput, TrianglesTurnedOverAreMendedWithANote) {
  const std::vector<std::string> measured = {"validate", scene_, "--no-cloth", "--samples", "2000", "--json"};
  const auto figures = [&](const std::string& name, std::string& said) {
    std::vector<std::string> words = measured;
    words.push_back((folder_ / name).string());
    const Outcome outcome = run_program(words);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    said = outcome.output;
    return json::parse(read_file(folder_ / name));
  };
  std::string before, after;
  const json right = figures("right.json", before);
  turn_some_triangles();
  const json mended = figures("mended.json", after);
  const std::string note = "note: body.dae: 4 triangles were turned over: mended\n";
  EXPECT_THAT(before, Not(HasSubstr("turned over")));
  EXPECT_EQ(count_of(after, note), 1) << after;
  EXPECT_EQ(mended["under_mm"], right["under_mm"]);
  EXPECT_EQ(mended["over_mm"], right["over_mm"]);

  const Outcome fit = run_program(
      {"fit", (folder_ / "body.dae").string(), "--motion", (folder_ / "small-motion.json").string(), "--count", "2"});
  EXPECT_EQ(fit.status, 0) << fit.output;
  EXPECT_EQ(count_of(fit.output, note), 1) << fit.output;
  EXPECT_EQ(count_of(play(scene_, {"--backend", "mesh"}).output, note), 1);
  EXPECT_EQ(
      count_of(run_program({"validate", scene_, "--no-cloth", "--samples", "500", "--backend", "mesh"}).output, note),
      1);
}

} // namespace
} // namespace tutu::test
