// tutu validate as a user meets it: exit statuses, JSON, the report, bad input; on bodies whose shape is known.
#include "rig/io/file_io.h"
#include "src/measure/validation.h"
#include "src/study/report/validation_html.h"
#include "tests/support/capsule_character.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::test;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

const proxies::Capsule k_trunk{{0, 0.3, 0}, {0, 0.7, 0}, 0.12}, k_arm{{0.4, 0.3, 0}, {0.4, 0.7, 0}, 0.05};

class ValidateCommand : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = scratch_folder();
    CapsuleBody body;
    body.add(k_trunk, 64, 16, 12);
    write_capsule_character(folder_ / "body.dae", body, {0, 0.5, 0});
    file("still.json", R"({"keys": [{"time": 0, "joints": {}}]})");
    file("turn.json", R"({"keys": [{"time": 0, "joints": {}},
      {"time": 0.2, "joints": {"Hips": {"rotation": [0, 0.5, 0, 0.8660254037844386]}}}]})");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) {
    write_file(folder_ / name, text);
    return (folder_ / name).string();
  }
  std::string scene(const std::vector<proxies::Capsule>& capsules, const std::string& motion = "still.json",
                    const std::string& character = "body.dae", const std::string& more = "") {
    file("proxies.json", proxies_json(capsules));
    return file("scene.json", "{\"character\": \"" + character + "\", \"motion\": \"" + motion +
                                  "\", \"proxies\": \"proxies.json\", \"ground\": {\"height\": 0}" + more + "}");
  }
  Outcome validate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "validate");
    arguments.insert(arguments.end(), {"--samples", "4000"});
    return run_program(arguments);
  }
  json figures_of(std::vector<std::string> arguments, int status = 0) {
    arguments.insert(arguments.end(), {"--json", (folder_ / "v.json").string()});
    const Outcome outcome = validate(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.output;
    return json::parse(read_file(folder_ / "v.json"));
  }
  void expect_refused(const std::vector<std::string>& arguments, const ::testing::Matcher<std::string>& message) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, message);
    const std::size_t last = outcome.output.rfind("tutu: "); // one line, after what the importer has to say
    ASSERT_NE(last, outcome.output.npos);
    EXPECT_EQ(std::count(outcome.output.begin() + static_cast<std::ptrdiff_t>(last), outcome.output.end(), '\n'), 1);
    EXPECT_TRUE(last == 0 || outcome.output.starts_with("note: ")) << outcome.output;
  }

  std::filesystem::path folder_;
};

constexpr double k_file_mm = 0.06; // coordinates of the file are rounded, and chords lie below the capsule

TEST_F(ValidateCommand, ABodyMadeFromItsProxyHasNoError) {
  const json v = figures_of({scene({k_trunk})});
  EXPECT_NEAR(v["under_mm"]["max"], 0.0, k_file_mm);
  EXPECT_LE(v["under_mm"]["bound"], 0.2 + k_file_mm);
  EXPECT_LE(v["over_mm"]["max"], 0.5); // chords of a 64-gon: 0.15 mm, of the caps as much again
  EXPECT_EQ(v["coverage"], 1.0);
  EXPECT_NEAR(v["volume_ratio"].get<double>(), 1.0, 0.01);
  EXPECT_NEAR(v["volume_l"]["body"].get<double>(), 1000 * std::numbers::pi * 0.0144 * (0.4 + 0.16), 0.3);
  EXPECT_GT(v["body"]["buried_share"], 0.001); // the joint's grain
  EXPECT_THAT(v["never_touching"], ::testing::IsEmpty());
}

TEST_F(ValidateCommand, AProxyMovedByTenMillimetresShowsAsTenOnBothSides) {
  const Vec3 move(0, 0, 0.010);
  const std::string moved = scene({{k_trunk.a + move, k_trunk.b + move, k_trunk.radius}}, "turn.json");
  const json v = figures_of({moved, "--every", "4"});
  EXPECT_EQ(v["frames"], 3);
  EXPECT_NEAR(v["under_mm"]["max"], 10.0, 0.1 + k_file_mm);
  EXPECT_NEAR(v["over_mm"]["max"], 10.0, 0.3);
  EXPECT_GE(v["under_mm"]["bound"], v["under_mm"]["max"]);
  EXPECT_GE(v["over_mm"]["bound"], v["over_mm"]["max"]);
  EXPECT_LE(v["hausdorff_mm"]["value"], v["hausdorff_mm"]["bound"]);

  const Outcome missed = validate({moved, "--every", "12", "--tolerance-mm", "5"});
  EXPECT_EQ(missed.status, 1);
  EXPECT_THAT(missed.output, HasSubstr("NOT met"));
  EXPECT_EQ(validate({moved, "--every", "12", "--tolerance-mm", "18"}).status, 0);
  EXPECT_EQ(validate({moved, "--every", "12", "--tolerance-mm", "10.2", "--judge", "p99"}).status, 0);
}

TEST_F(ValidateCommand, AMissingArmIsUncovered) {
  CapsuleBody body;
  body.add(k_trunk, 48, 12, 8);
  body.add(k_arm, 24, 6, 8);
  write_capsule_character(folder_ / "two.dae", body, {0, 0.5, 0});
  const json whole = figures_of({scene({k_trunk, k_arm}, "still.json", "two.dae")});
  EXPECT_EQ(whole["coverage"], 1.0);
  const json missing = figures_of({scene({k_trunk}, "still.json", "two.dae")});
  const double arm = 2 * std::numbers::pi * 0.05 * (0.4 + 0.1), trunk = 2 * std::numbers::pi * 0.12 * (0.4 + 0.24);
  EXPECT_NEAR(missing["coverage"].get<double>(), trunk / (trunk + arm), 0.01);
  EXPECT_NEAR(missing["under_mm"]["max"].get<double>(), 330.0, 1.0); // the arm's far side
  const json apart = figures_of({scene({k_trunk, {{2, 0, 0}, {2, 1, 0}, 0.1}}, "still.json", "two.dae")});
  EXPECT_THAT(apart["never_touching"], ::testing::ElementsAre("p1"));
  EXPECT_EQ(apart["proxies"][0]["name"], "p1"); // the worst first
}

TEST_F(ValidateCommand, TheJsonHasWhatItPromises) {
  const json v = figures_of({scene({k_trunk}, "turn.json"), "--every", "4"});
  for (const char* key : {"frames", "tolerance_mm", "under_mm", "over_mm", "coverage", "volume_ratio", "proxies",
                          "joints", "regions", "core", "worst_frames", "hausdorff_mm", "per_frame", "body"})
    EXPECT_TRUE(v.contains(key)) << key;
  for (const char* side : {"under_mm", "over_mm"})
    for (const char* key : {"mean", "rms", "p95", "p99", "max", "bound"}) EXPECT_TRUE(v[side].contains(key)) << key;
  for (const char* key : {"name", "joint", "under_mm", "over_mm"}) EXPECT_TRUE(v["proxies"][0].contains(key)) << key;
  EXPECT_EQ(v["frames"], 3);
  EXPECT_EQ(v["per_frame"][1]["frame"], 4);
  EXPECT_EQ(v["per_frame"][0]["collisions"], json::array({"p0"}));
  EXPECT_EQ(v["regions"][0]["name"], "torso");
  EXPECT_FALSE(v.contains("cloth_in_body"));
}

TEST_F(ValidateCommand, ABodyThatStandsInClothIsCountedThoughTheProxiesKnowNothing) {
  // Two sheets hang through each other and through the body; the proxy stands beside.
  const auto hung = [&](const std::string& name, const std::string& from_and_across) {
    return file(name + ".json", R"({"name": ")" + name +
                                    R"(", "shape": {"grid": {"rows": 9, "columns": 9, "down": [0, -0.8, 0], )" +
                                    from_and_across + R"(}}, "attachments": [{"joint": "Hips", "rows": 0}]})");
  };
  hung("plain", R"("corner": [-0.3, 1.0, 0], "across": [0.6, 0, 0])");
  hung("slant", R"("corner": [-0.3, 1.0, -0.05], "across": [0.6, 0, 0.1])");
  const std::string s =
      scene({{{2, 0, 0}, {2, 1, 0}, 0.1}}, "still.json", "body.dae", R"(, "garments": ["plain.json", "slant.json"])");
  const std::string html = (folder_ / "v.html").string();
  const json v = figures_of({s, "--html", html});
  const json& crossings = v["crossings"];
  ASSERT_EQ(crossings["garments"].size(), 2u);
  for (const json& garment : crossings["garments"]) {
    EXPECT_EQ(garment["body"]["frames"], v["frames"]) << garment;
    EXPECT_GE(garment["body"]["worst"], 1) << garment;
    EXPECT_EQ(garment["proxies"]["total"], 0) << garment;
  }
  EXPECT_GE(crossings["each_other"]["worst"], 1);
  EXPECT_EQ(v["per_frame"][0]["crossings"]["garments"][0]["name"], "plain");
  EXPECT_GE(v["per_frame"][0]["crossings"]["garments"][0]["body"]["crossings"], 1);
  EXPECT_THAT(read_file(html), HasSubstr("plain, the body"));
  EXPECT_FALSE(figures_of({s, "--no-cloth"}).contains("crossings"));
}

TEST_F(ValidateCommand, ThreadsGiveTheSameFigures) {
  const Vec3 move(0.01, 0, 0.01);
  const std::string s = scene({{k_trunk.a + move, k_trunk.b - move, k_trunk.radius}}, "turn.json");
  json one = figures_of({s, "--every", "3", "--threads", "1"}),
       three = figures_of({s, "--every", "3", "--threads", "3"});
  one.erase("seconds");
  three.erase("seconds");
  EXPECT_EQ(one, three);
}

TEST_F(ValidateCommand, TheReportIsOneWholePage) {
  const std::string html = (folder_ / "v.html").string();
  const Outcome outcome = validate({scene({k_trunk}, "turn.json"), "--html", html, "--every", "6"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const std::string page = read_file(html);
  EXPECT_THAT(page, AllOf(::testing::StartsWith("<!doctype html>"), ::testing::EndsWith("</html>\n")));
  EXPECT_THAT(page, AllOf(HasSubstr("<svg"), HasSubstr("viewport"), HasSubstr("p0")));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("http")), Not(HasSubstr("<script")))); // nothing from elsewhere
  EXPECT_TRUE(page.find("data:image/png;base64,") != page.npos || page.find("No pictures: ") != page.npos);
}

TEST_F(ValidateCommand, InputThatCannotBeIsStatus2) {
  expect_refused({"validate", file("none.json", R"({"character": "body.dae", "motion": "still.json"})")},
                 HasSubstr("none.json: /proxies: found none, expected proxies to validate"));
  const std::string good = scene({k_trunk});
  expect_refused({"validate", good, "--reach"}, HasSubstr("without garments"));
  expect_refused({"validate", good, "--json", (folder_ / "nowhere" / "v.json").string()}, HasSubstr("nowhere"));
  EXPECT_EQ(run_program({"validate", good, "--judge", "mean"}).status, 2);
  EXPECT_EQ(run_program({"validate", good, "--tolerance-mm", "nan"}).status, 2);
  EXPECT_EQ(run_program({"validate", good, "--every", "0"}).status, 2);

  file("proxies.json", R"({"proxies": [{"sphere": {"joint": "Tail", "center": [0,0,0], "radius": 0.1}}]})");
  expect_refused({"validate", good}, AllOf(HasSubstr("/proxies/0"), HasSubstr("Tail")));
  file("proxies.json", R"({"proxies": [{"sphere": {"center": [0,0,0], "radius": 0.1}}]})");
  expect_refused({"validate", good}, AllOf(HasSubstr("/proxies/0"), HasSubstr("joint")));
  file("alien.json", R"({"keys": [{"time": 0, "joints": {"Tentacle": {"translation": [0,0,0]}}}]})");
  expect_refused({"validate", scene({k_trunk}, "alien.json")}, HasSubstr("Tentacle"));
}

TEST_F(ValidateCommand, BodiesWithoutSidesAreStatus2) {
  CapsuleBody inverted;
  inverted.add(k_trunk, 24, 6, 4);
  for (rig::Triangle& t : inverted.triangles) std::swap(t[1], t[2]);
  write_capsule_character(folder_ / "inverted.dae", inverted, {0, 0.5, 0});
  expect_refused({"validate", scene({k_trunk}, "still.json", "inverted.dae")},
                 HasSubstr("inverted.dae: body mesh: found a body turned inside out, expected "));
  CapsuleBody flat;
  flat.add(k_trunk, 24, 6, 4);
  float height = 0.0f; // all corners apart, on one line
  for (Vec3f& p : flat.positions) p = Vec3f(0.0f, height += 0.01f, 0.0f);
  write_capsule_character(folder_ / "flat.dae", flat, {0, 0.5, 0}, 0.0);
  expect_refused({"validate", scene({k_trunk}, "still.json", "flat.dae")}, HasSubstr("area"));
  expect_refused({"fit", (folder_ / "flat.dae").string(), "--motion", (folder_ / "still.json").string()},
                 AllOf(HasSubstr("flat.dae"), HasSubstr("area")));
  expect_refused({"fit", (folder_ / "inverted.dae").string(), "--motion", (folder_ / "still.json").string()},
                 AllOf(HasSubstr("inverted.dae"), HasSubstr("inside out")));
}

TEST_F(ValidateCommand, ABodyThatIsNoManifoldIsMeasuredByWindingNumbers) {
  CapsuleBody fin;
  fin.add(k_trunk, 24, 6, 4);
  const std::uint32_t tip = static_cast<std::uint32_t>(fin.positions.size());
  fin.positions.emplace_back(0.4f, 0.5f, 0.0f);
  fin.triangles.push_back({fin.triangles[30][0], fin.triangles[30][1], tip}); // a third triangle on an edge
  write_capsule_character(folder_ / "fin.dae", fin, {0, 0.5, 0});
  const Outcome outcome = validate({scene({k_trunk}, "still.json", "fin.dae")});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("winding number"));
}

TEST_F(ValidateCommand, InterruptedItLeavesNothing_slow) {
  const std::string html = (folder_ / "v.html").string(), figures = (folder_ / "v.json").string();
  const Outcome outcome =
      run_program({"validate", source_file("assets/scenes/dance.json").string(), "--html", html, "--json", figures},
                  "timeout --preserve-status -s INT 3");
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("interrupted"));
  EXPECT_FALSE(std::filesystem::exists(html));
  EXPECT_FALSE(std::filesystem::exists(figures));
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_THAT(entry.path().extension().string(), ::testing::AnyOf(".json", ".dae")) << entry.path();
}

TEST_F(ValidateCommand, TheDancersClothIsMeasured_slow) {
  const json v = figures_of({source_file("assets/scenes/dance.json").string(), "--every", "120"});
  const json& cloth = v["cloth_in_body"];
  for (const char* key : {"share", "max_mm", "p99_mm", "particles", "edges", "triangles"})
    EXPECT_TRUE(cloth.contains(key)) << key;
  EXPECT_EQ(cloth["particles"]["asked"], 6 * 1080);
  EXPECT_EQ(v["crossings"]["garments"].size(), 2u);
  EXPECT_GT(v["in_reach"]["skin_share"], 0.5);
  EXPECT_LT(v["in_reach"]["skin_share"], 1.0);
  EXPECT_LE(v["in_reach"]["under_mm"]["bound"], v["under_mm"]["bound"]);
}

} // namespace
