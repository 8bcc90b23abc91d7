// tutu plan as a user meets it, on a scene that runs in a moment.
#include "proxies/proxy_file.h"
#include "rig/io/file_io.h"
#include "src/scene/load.h"
#include "src/scene/saved_drape.h"
#include "src/scene/scene_write.h"
#include "src/study/plan/plan_proxies.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class PlanCommand : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = scratch_folder();
    scene_ = write_small_scene(folder_);
    out_ = folder_ / "least.json";
    // Beside the trunk one proxy that the sheet can never reach.
    json all = json::parse(read_file(folder_ / "proxies.json"));
    all["proxies"].push_back(
        json::parse(R"({"name": "far", "sphere": {"joint": "Hips", "center": [0, -40, 0], "radius": 0.1}})"));
    write_file(folder_ / "proxies.json", all.dump());
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome plan(const std::vector<std::string>& more) {
    std::vector<std::string> words = {"plan",
                                      scene_,
                                      "-o",
                                      out_.string(),
                                      "--json",
                                      (folder_ / "plan.json").string(),
                                      "--cache",
                                      (folder_ / "cache").string(),
                                      "--reference-substeps",
                                      "4,8,16"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }
  json figures() const { return json::parse(read_file(folder_ / "plan.json")); }

  fs::path folder_, out_;
  std::string scene_;
};

TEST_F(PlanCommand, GivesAModelThatMeetsTheErrorAndLeavesOutWhatIsOutOfReach) {
  const Outcome outcome = plan({"--error-mm", "20", "--starts", "2"});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("inside of the true body"), HasSubstr("met: "), HasSubstr("substeps")));
  const json j = figures();
  EXPECT_TRUE(j["met"].get<bool>());
  EXPECT_LE(j["measured"]["body_mm"].get<double>(), 20.0);
  EXPECT_LE(j["measured"]["drape_mm"].get<double>(), j["limits"]["drape_mm"].get<double>());
  for (const json& choice : j["choices"]) EXPECT_FALSE(choice["reason"].get<std::string>().empty());

  const LoadedScene least = load_scene(read_scene(out_));
  EXPECT_LE(least.settings.substeps, 8);
  for (const proxies::Proxy& proxy : least.proxies) EXPECT_NE(proxy.name, "far");
  for (const json& proxy : j["proxies"])
    if (proxy["name"] == "far") {
      EXPECT_FALSE(proxy["in_reach"].get<bool>());
      EXPECT_GT(proxy["clearance_mm"].get<double>(), 1000.0);
    }
  bool stale = true;
  EXPECT_TRUE(saved_drape(least, &stale).has_value()) << "it starts from where it was measured";
  EXPECT_EQ(run_program({"play", out_.string(), "--headless", "--no-pictures"}).status, 0);
}

TEST_F(PlanCommand, SaysWhenTheErrorCannotBeMetAndWritesTheBest) {
  const Outcome outcome = plan({"--error-mm", "0.001", "--error", "trajectory", "--starts", "1"});
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("NOT MET: the stated error cannot be met"));
  EXPECT_FALSE(figures()["met"].get<bool>());
  EXPECT_GT(figures()["measured"]["trajectory_mm"].get<double>(), 0.001);
  EXPECT_NO_THROW(load_scene(read_scene(out_)));
}

TEST_F(PlanCommand, BadInputIsToldInOneMessage) {
  const auto told = [&](const std::vector<std::string>& words, const char* what) {
    const Outcome outcome = run_program(words);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(what));
    EXPECT_LE(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 2) << outcome.output;
  };
  told({"plan", scene_}, "--error-mm is required");
  told({"plan", scene_, "--error-mm", "nan"}, "--error-mm");
  told({"plan", scene_, "--error-mm", "-1"}, "--error-mm");
  told({"plan", scene_, "--error-mm", "2", "--error", "beauty"}, "beauty");
  told({"plan", scene_, "--error-mm", "2", "--ms", "0"}, "--ms");
  told({"plan", (folder_ / "none.json").string(), "--error-mm", "2"}, "none.json");
  told({"plan", scene_, "--error-mm", "2", "-o", scene_}, "it would be overwritten");
  told({"plan", scene_, "--error-mm", "2", "-o", (folder_ / "no" / "x.json").string()}, "no folder");
  write_file(folder_ / "bare.json", R"({"character": "body.dae", "motion": "small-motion.json"})");
  told({"plan", (folder_ / "bare.json").string(), "--error-mm", "2"}, "garments");
}

TEST(PlanProxies, ThoseThatStayAreInReachAndWereTouched) {
  const fs::path folder = scratch_folder();
  const std::string file = write_small_scene(folder);
  LoadedScene scene = load_scene(read_scene(file));
  proxies::Proxy beside = scene.proxies.front(), beyond = beside, off = beside;
  const auto move = [](proxies::Proxy& proxy, const char* name,
                       const Vec3& by) { // turned nowhere: a joint's axes are the world's
    proxy.name = name;
    proxy.a.points[0] += by;
    proxy.b.points[0] += by;
  };
  move(beside, "in reach, under the cloth", {0, -0.35, 0}); // the sheet could hang down to it, and lies on the trunk
  move(beyond, "beyond", {0, -30, 0});
  move(off, "disabled", {0, 0, 0});
  off.enabled = false;
  scene.proxies.insert(scene.proxies.end(), {beside, beyond, off});

  std::vector<Trajectory> runs(1);
  std::vector<Vec3> positions = scene.garments[0].rest_positions;
  for (Vec3& p : positions) p.y() = 0.825; // 5 mm above the trunk's end
  runs[0].moments.push_back({0.0, {positions}, {}});
  PlanProxies proxies(scene, runs);
  const auto names = [&](ProxiesKept kept) {
    PlanModel model;
    model.kept = kept;
    std::vector<std::string> result;
    for (const proxies::Proxy& proxy : proxies.of(model, [] { return true; })) result.push_back(proxy.name);
    return result;
  };
  const std::string trunk = scene.proxies.front().name;
  EXPECT_EQ(names(ProxiesKept::all), (std::vector<std::string>{trunk, beside.name, beyond.name}));
  EXPECT_EQ(names(ProxiesKept::in_reach), (std::vector<std::string>{trunk, beside.name}));
  PlanModel model;
  model.kept = ProxiesKept::touched;
  const auto kept = proxies.of(model, [] { return true; });
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].name, trunk);
  EXPECT_NEAR(proxies.uses(model)[0].nearest, 0.005, 1e-3);
  EXPECT_NEAR(proxies.uses(model)[1].nearest, 0.355, 1e-3);
  fs::remove_all(folder);
}

TEST(SceneWrite, EveryKindOfMotion) {
  const fs::path folder = scratch_folder();
  SceneDescription d = read_scene(write_small_scene(folder));
  const fs::path file = folder / "motion.json", some = folder / "sheet.json"; // any file that is there
  const auto back = [&](const MotionSource& motion) {
    d.motion = motion;
    write_scene(d, file);
    return read_scene(file).motion;
  };
  const auto clip = std::get<ClipMotion>(back(ClipMotion{some, d.character}));
  EXPECT_TRUE(fs::equivalent(clip.clip, some));
  EXPECT_TRUE(clip.retarget_from && fs::equivalent(*clip.retarget_from, d.character));
  EXPECT_EQ(std::get<int>(std::get<OwnMotion>(back(OwnMotion{3})).animation), 3);
  EXPECT_EQ(std::get<std::string>(std::get<OwnMotion>(back(OwnMotion{"walk"})).animation), "walk");
  const auto texts = std::get<rig::ThreeTexts>(back(rig::ThreeTexts{some, d.character, some, some}));
  EXPECT_TRUE(fs::equivalent(texts.rotations, d.character));
  EXPECT_TRUE(texts.joints && fs::equivalent(*texts.joints, some));
  const auto take =
      std::get<MocapMotion>(back(MocapMotion{some, {7, 0.5, 2.5}, {{"hip", "Hips"}, {"eye", std::nullopt}}}));
  EXPECT_EQ(take.options.rest_frame, 7);
  EXPECT_EQ(take.options.from, 0.5);
  EXPECT_EQ(take.options.to, 2.5);
  EXPECT_EQ(take.joints, (std::map<std::string, std::optional<std::string>>{{"hip", "Hips"}, {"eye", std::nullopt}}));
  d.interpolation = rig::Interpolation::cubic;
  d.skinning = rig::Skinning::dual_quaternion;
  back(OwnMotion{0});
  EXPECT_EQ(read_scene(file).interpolation, rig::Interpolation::cubic);
  EXPECT_EQ(read_scene(file).skinning, rig::Skinning::dual_quaternion);
  fs::remove_all(folder);
}

TEST(SceneWrite, ReadsBackWhatWasWritten) {
  const fs::path folder = scratch_folder();
  SceneDescription d = read_scene(write_small_scene(folder));
  d.settings.substeps = 3;
  d.settings.adaptive_substeps = false;
  d.settings.features = cloth::ContactFeatures::triangles;
  d.settings.swept = false;
  d.settings.passes = 2;
  d.ground_height.reset();
  d.wind = {{3, 0, -1.5}, cloth::Gusts{1.5, 0.8, 7}};
  d.garments[0].resolution = 1.5;
  d.garments[0].offset = {0, 0.1, 0};
  fs::create_directories(folder / "elsewhere");
  const fs::path file = folder / "elsewhere" / "written.json";
  write_scene(d, file, "why");
  const SceneDescription back = read_scene(file);
  EXPECT_EQ(back.settings.substeps, 3);
  EXPECT_FALSE(back.settings.adaptive_substeps);
  EXPECT_EQ(back.settings.features, cloth::ContactFeatures::triangles);
  EXPECT_FALSE(back.settings.swept);
  EXPECT_EQ(back.settings.passes, 2);
  EXPECT_FALSE(back.ground_height.has_value());
  EXPECT_EQ(back.wind, d.wind);
  EXPECT_EQ(back.garments[0].resolution, 1.5);
  EXPECT_EQ(back.garments[0].offset, Vec3(0, 0.1, 0));
  EXPECT_TRUE(fs::equivalent(back.character, d.character));
  EXPECT_TRUE(fs::equivalent(*back.proxies, *d.proxies));
  EXPECT_TRUE(fs::equivalent(back.drape.parent_path(), d.drape.parent_path()));
  fs::remove_all(folder);
}

} // namespace
