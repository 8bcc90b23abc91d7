// The program as a user meets it: bad input gives one message and status 2, good input the promised files.
#include "rig/io/file_io.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::test;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

class Program : public ::testing::Test {
protected:
  void SetUp() override { folder_ = scratch_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) {
    write_file(folder_ / name, text);
    return (folder_ / name).string();
  }

  /// A small scene on the shipped dancer; `more` are further members.
  std::string scene(const std::string& more) {
    return file("scene.json", "{\"character\": \"" + source_file("assets/characters/dancer.dae").string() +
                                  "\", \"motion\": \"" + source_file("assets/poses/dance.json").string() + "\"" + more +
                                  "}");
  }

  /// Expects exit status 2, one line, and this text in it.
  void expect_refused(const std::vector<std::string>& arguments, const ::testing::Matcher<std::string>& message) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, message);
    EXPECT_THAT(outcome.output, ::testing::StartsWith("tutu: "));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  }

  std::filesystem::path folder_;
};

TEST_F(Program, HelpAndVersion) {
  EXPECT_EQ(run_program({"--help"}).status, 0);
  EXPECT_THAT(run_program({"--help"}).output, AllOf(HasSubstr("play"), HasSubstr("drape"), HasSubstr("inspect")));
  EXPECT_EQ(run_program({"--version"}).status, 0);
  for (const char* command : {"play", "drape", "inspect", "mannequin"})
    EXPECT_EQ(run_program({command, "--help"}).status, 0) << command;
}

TEST_F(Program, BadUsageIsStatus2) {
  EXPECT_EQ(run_program({}).status, 2);
  EXPECT_EQ(run_program({"dance"}).status, 2);
  EXPECT_EQ(run_program({"play", "--substeps", "0"}).status, 2);
  EXPECT_EQ(run_program({"play", "--backend", "magic"}).status, 2);
  EXPECT_EQ(run_program({"play", "--show", "soul"}).status, 2);
}

TEST_F(Program, ScenesThatCannotBe) {
  expect_refused({"play", (folder_ / "none.json").string()}, HasSubstr("none.json: found no such file"));
  expect_refused({"play", file("empty.json", "")}, HasSubstr("an empty file"));
  expect_refused({"play", file("cut.json", "{\"character\": \"a")}, HasSubstr("line 1"));
  expect_refused({"play", file("bare.json", "{}")}, HasSubstr("no key \"character\""));
  expect_refused({"play", scene(", \"garmets\": []")},
                 HasSubstr("/garmets: found unknown key \"garmets\", expected one of"));
  expect_refused({"play", scene(", \"solver\": {\"substeps\": 0}")}, HasSubstr("/solver/substeps: found 0"));
  expect_refused({"play", scene(", \"solver\": {\"name\": \"magic\"}")}, HasSubstr("/solver/name"));
  expect_refused({"play", scene(", \"collision\": {\"backend\": \"magic\"}")}, HasSubstr("/collision/backend"));
  expect_refused({"play", scene(", \"ground\": {\"height\": 1e999}")}, HasSubstr("finite"));
  expect_refused({"play", scene(", \"garments\": [\"none.json\"]")}, HasSubstr("none.json"));
  expect_refused({"play", scene(", \"proxies\": \"none.json\"")}, HasSubstr("none.json"));
  expect_refused({"play", file("s.json", R"({"character": "none.dae", "motion": "m.json"})")}, HasSubstr("none.dae"));
  expect_refused({"play", file("s2.json", "{\"character\": \"" + source_file("assets/characters/dancer.dae").string() +
                                              "\", \"motion\": {\"animation\": 3}}")},
                 HasSubstr("/motion/animation: found 3"));
}

TEST_F(Program, ProxiesThatCannotBe) {
  const auto with = [&](const std::string& proxies) {
    file("proxies.json", proxies);
    return scene(", \"proxies\": \"proxies.json\"");
  };
  expect_refused({"play", with(R"({"proxies": [{"sphere": {"joint": "Tail", "center": [0,0,0], "radius": 0.1}}]})")},
                 AllOf(HasSubstr("proxies.json: /proxies/0"), HasSubstr("Tail")));
  expect_refused({"play", with(R"({"proxies": [{"sphere": {"joint": "Hips", "center": [0,0,0], "radius": -0.1}}]})")},
                 HasSubstr("/proxies/0/sphere/radius: found -0.1"));
  expect_refused({"play", with(R"({"proxies": [{"cube": {}}]})")}, HasSubstr("cube"));
}

TEST_F(Program, GarmentsThatCannotBe) {
  const auto with = [&](const std::string& garment) {
    file("garment.json", garment);
    return scene(", \"garments\": [\"garment.json\"]");
  };
  const std::string shape =
      R"("shape": {"grid": {"rows": 3, "columns": 3, "corner": [0,1,0.2], "across": [0.2,0,0], "down": [0,-0.2,0]}})";
  expect_refused({"play", with("{" + shape + R"(, "attachments": [{"joint": "Tail", "rows": 0}]})")},
                 AllOf(HasSubstr("/attachments/0/joint"), HasSubstr("Tail")));
  expect_refused({"play", with(R"({"shape": {"tube": {"rows": 3, "columns": 8, "rings": []}}})")},
                 HasSubstr("/shape/tube/rings"));
}

TEST_F(Program, ClipsThatCannotBe) {
  const auto with = [&](const std::string& clip) {
    file("clip.json", clip);
    return file("scene.json", "{\"character\": \"" + source_file("assets/characters/dancer.dae").string() +
                                  "\", \"motion\": \"clip.json\"}");
  };
  expect_refused({"play", with(R"({"keys": []})")}, HasSubstr("clip.json"));
  expect_refused({"play", with(R"({"keys": [{"time": 0, "joints": {}}, {"time": 0, "joints": {}}]})")},
                 HasSubstr("/keys/1"));
  expect_refused({"play", with(R"({"keys": [{"time": 0, "joints": {"Tail": {"translation": [0,0,0]}}}]})")},
                 HasSubstr("Tail"));
  expect_refused({"play", with(R"({"keys": [{"time": 0, "joints": {"Hips": {"rotation": [0,0,0,0]}}}]})")},
                 HasSubstr("rotation"));
}

TEST_F(Program, TextsWithTheWrongNumberOfJoints) {
  file("t.txt", "0 1 0\n");
  file("r.txt", "0 0 0 1\n");
  file("k.txt", "0\n");
  const std::string s = file("scene.json", "{\"character\": \"" + source_file("assets/characters/dancer.dae").string() +
                                               "\", \"motion\": {\"texts\": {\"translations\": \"t.txt\", "
                                               "\"rotations\": \"r.txt\", \"times\": \"k.txt\"}}}");
  expect_refused({"play", s}, AllOf(HasSubstr("t.txt"), HasSubstr("line 1"), HasSubstr("156")));
}

TEST_F(Program, CharactersThatCannotBe) {
  for (const auto& entry : std::filesystem::directory_iterator(assimp_model("invalid")))
    EXPECT_EQ(run_program({"inspect", entry.path().string()}).status, 2) << entry.path();
  expect_refused({"inspect", file("empty.dae", "")}, HasSubstr("empty.dae"));
  expect_refused({"inspect", file("text.glb", "glTF or not")}, HasSubstr("text.glb"));
  expect_refused({"inspect", "/usr"}, HasSubstr("/usr"));
}

TEST_F(Program, DivergenceIsStatus1WithItsPlaceAndLeavesNoFilm_slow) {
  // Neither five substeps a frame nor 64 times as many carry cloth this stiff.
  file(
      "stiff.json",
      R"({"name": "stiff", "shape": {"tube": {"rows": 12, "columns": 16, "rings": [{"height": 1.05, "radius": 0.2}, {"height": 0.6, "radius": 0.3}]}},
    "fabric": {"stretch": 9e8}, "attachments": [{"joint": "Hips", "rows": 0}]})");
  const Outcome outcome = run_program(
      {"play", scene(", \"garments\": [\"stiff.json\"], \"solver\": {\"name\": \"mass_spring\", \"substeps\": 5}"),
       "--headless", "-o", (folder_ / "film.mp4").string(), "--json", (folder_ / "stats.json").string()});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("stiff diverged in frame"), HasSubstr("particle"),
                                    HasSubstr("largest force"), HasSubstr("7 tries")));
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_EQ(entry.path().extension(), ".json") << entry.path();
}

TEST_F(Program, RecoveriesAreCountedAndToldWithTheirPlace_slow) {
  file(
      "stiff.json",
      R"({"name": "stiff", "shape": {"tube": {"rows": 12, "columns": 16, "rings": [{"height": 1.05, "radius": 0.2}, {"height": 0.6, "radius": 0.3}]}},
    "fabric": {"stretch": 2000}, "attachments": [{"joint": "Hips", "rows": 0}]})");
  const std::string s = scene(", \"garments\": [\"stiff.json\"], \"solver\": {\"name\": \"mass_spring\", \"substeps\": "
                              "5, \"adaptive_substeps\": false}");
  std::string hashes[2];
  for (std::string& hash : hashes) {
    const Outcome outcome =
        run_program({"play", s, "--no-pictures", "--frames", "60", "--json", (folder_ / "stats.json").string()});
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("stiff recovered in frame"), HasSubstr("from particle")));
    const nlohmann::json stats = nlohmann::json::parse(read_file(folder_ / "stats.json"));
    EXPECT_GT(stats.at("recoveries"), 0);
    EXPECT_EQ(stats.at("diverged"), false);
    EXPECT_LT(stats.at("longer_pct").at("p99"), 10.0);
    EXPECT_THAT(stats.at("first_recoveries").at(0).get<std::string>(), HasSubstr("of 5"));
    hash = stats.at("state_hash").get<std::string>();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(Program, TheJumpingHumanJumpsInHisSkirt_slow) {
  const Outcome outcome = run_program({"play", source_file("assets/scenes/epileptic.json").string(), "--no-pictures",
                                       "--json", (folder_ / "stats.json").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(nlohmann::json::parse(read_file(folder_ / "stats.json")).at("frames"), 198);
}

TEST_F(Program, TheDancerFollowsATakeOfMotionCapture_slow) {
  const Outcome outcome = run_program({"play", source_file("assets/scenes/mocap.json").string(), "--no-pictures",
                                       "--json", (folder_ / "stats.json").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json stats = nlohmann::json::parse(read_file(folder_ / "stats.json"));
  EXPECT_EQ(stats.at("frames"), 719);
  EXPECT_LT(stats.at("longer_pct").at("p99"), 5.0);
  EXPECT_LT(stats.at("penetration_mm").at("proxies").at("max"), 1.0);
}

TEST_F(Program, AHumanDancesOurDance_slow) {
  if (!std::filesystem::exists(human("human-female.dae")))
    GTEST_SKIP() << "no human test characters beside the checkout";
  const Outcome outcome = run_program({"play", source_file("tests/fixtures/scenes/human.json").string(),
                                       "--no-pictures", "--json", (folder_ / "stats.json").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(nlohmann::json::parse(read_file(folder_ / "stats.json")).at("diverged"), false);
}

TEST_F(Program, PicturesAndFilmsAppearWhole_slow) {
  const std::string dance = source_file("assets/scenes/dance.json").string();
  Outcome outcome =
      run_program({"play", dance, "--at", "0,3", "-o", (folder_ / "stills").string(), "--size", "320x180"});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "stills" / "dance-0000.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "stills" / "dance-0003.png"));
  outcome = run_program(
      {"play", dance, "--headless", "--frames", "5", "-o", (folder_ / "film.mp4").string(), "--size", "320x180"});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_GT(std::filesystem::file_size(folder_ / "film.mp4"), 1000u);
}

TEST_F(Program, ADrapeIsSavedAndUsed_slow) {
  const std::string dance = source_file("assets/scenes/dance.json").string();
  const std::string out = (folder_ / "dance.drape.json").string();
  const Outcome outcome = run_program({"drape", dance, "-o", out, "--seconds", "0.5"});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(nlohmann::json::parse(read_file(out)).at("garments").size(), 2u);
  // A scene whose drape no longer fits says so and drapes anew.
  file("old.drape.json", R"({"fingerprint": "1", "garments": []})");
  const Outcome stale =
      run_program({"play", scene(", \"drape\": \"old.drape.json\""), "--no-pictures", "--headless", "--frames", "2"});
  EXPECT_EQ(stale.status, 0);
  EXPECT_THAT(stale.output, HasSubstr("old.drape.json was made for another state of the scene"));
}

TEST_F(Program, TheDanceRunsAndReports_slow) {
  const Outcome outcome = run_program({"play", source_file("assets/scenes/dance.json").string(), "--no-pictures",
                                       "--frames", "60", "--json", (folder_ / "stats.json").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json stats = nlohmann::json::parse(read_file(folder_ / "stats.json"));
  EXPECT_EQ(stats.at("frames"), 60);
  EXPECT_EQ(stats.at("diverged"), false);
  EXPECT_EQ(stats.at("recoveries"), 0);
  EXPECT_EQ(stats.at("teleports"), 0);
  EXPECT_EQ(stats.at("substeps").at("asked"), 12);
  EXPECT_GE(stats.at("substeps").at("max"), 12);
  EXPECT_GE(stats.at("substeps").at("frames_split"), 0);
  for (const char* stage : {"pose", "proxies", "broad", "cloth", "contact", "skin", "total"})
    EXPECT_GT(stats.at("ms_per_frame").at(stage).at("median").get<double>(), 0.0) << stage;
  // The same run gives the same bits.
  const Outcome again = run_program({"play", source_file("assets/scenes/dance.json").string(), "--no-pictures",
                                     "--frames", "60", "--json", (folder_ / "again.json").string()});
  ASSERT_EQ(again.status, 0);
  EXPECT_EQ(nlohmann::json::parse(read_file(folder_ / "again.json")).at("state_hash"), stats.at("state_hash"));
}

} // namespace
