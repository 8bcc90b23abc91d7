// The pieces between a scene file and a moving scene.
#include "proxies/proxy_file.h"
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/run/drape.h"
#include "src/scene/load.h"
#include "src/scene/saved_drape.h"
#include "src/scene/scene_write.h"
#include "tests/support/paths.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

const LoadedScene& dance() {
  static const LoadedScene scene = load_scene(read_scene(source_file("assets/scenes/dance.json")));
  return scene;
}

TEST(Scene, TheDanceIsWhatTheReportHad) {
  const LoadedScene& scene = dance();
  EXPECT_EQ(scene.character.skeleton.joint_count(), 52);
  EXPECT_EQ(scene.character.mesh.parts.size(), 2u) << "two skins put in common";
  EXPECT_GE(rig::key_times(scene.motion).size(), 10u);
  EXPECT_GE(scene.motion.duration(), 8.0);
  ASSERT_EQ(scene.garments.size(), 2u);
  EXPECT_EQ(scene.garments[0].particle_count(), 30 * 30);
  EXPECT_EQ(scene.garments[0].seams.size(), 10u) << "sewn from the waist down to a third";
  EXPECT_EQ(scene.garments[1].particle_count(), 15 * 15);
  EXPECT_EQ(scene.proxies.size(), 36u) << "fitted";
  const auto by_hand = proxies::read_proxies(source_file("assets/proxies/dancer-hand.json"), scene.character.skeleton);
  int spheres = 0;
  for (const proxies::Proxy& proxy : by_hand) spheres += proxy.kind == proxies::ProxyKind::sphere;
  EXPECT_EQ(spheres, 9);
  EXPECT_EQ(by_hand.size(), 27u);
}

TEST(Scene, TheClipClosesItsLoop) {
  const auto& clip = std::get<rig::Clip>(dance().motion);
  const auto first = clip.key(0), last = clip.key(static_cast<int>(clip.times.size()) - 1);
  for (int j = 0; j < clip.joint_count; ++j) {
    EXPECT_LT((first[j].translation - last[j].translation).norm(), 1e-9) << j;
    EXPECT_LT(first[j].rotation.angularDistance(last[j].rotation), 1e-6) << j;
  }
}

TEST(Drape, ShippedDrapeFitsTheDance) {
  bool stale = true;
  EXPECT_TRUE(saved_drape(dance(), &stale).has_value()) << "run: tutu drape assets/scenes/dance.json";
  EXPECT_FALSE(stale);
}

TEST(Drape, FingerprintSeesWhatMatters) {
  LoadedScene scene = dance();
  const std::uint64_t before = drape_fingerprint(scene);
  EXPECT_EQ(drape_fingerprint(dance()), before);
  scene.garments[0].fabric.density *= 1.001;
  EXPECT_NE(drape_fingerprint(scene), before);
  scene = dance();
  scene.proxies[3].radius += 1e-4;
  EXPECT_NE(drape_fingerprint(scene), before);
  scene = dance();
  scene.ground_height = 0.01;
  EXPECT_NE(drape_fingerprint(scene), before);
}

TEST(SceneFile, SaysHowACharacterIsToBeRead) {
  const auto folder = scratch_folder();
  for (const char* name : {"a.dae", "m.json"}) write_file(folder / name, "");
  const auto read = [&](const std::string& more) {
    write_file(folder / "s.json", R"({"character": {"file": "a.dae")" + more + R"(}, "motion": "m.json"})");
    return read_scene(folder / "s.json");
  };
  EXPECT_EQ(read("").import.rest, rig::RestPose::bind);
  EXPECT_EQ(read(R"(, "height": 1.72)").import.height, 1.72);
  EXPECT_EQ(read(R"(, "unit": "cm")").import.metres_per_unit, 0.01);
  EXPECT_EQ(read(R"(, "unit": 0.0254)").import.metres_per_unit, 0.0254);
  EXPECT_EQ(read(R"(, "rest": "node")").import.rest, rig::RestPose::node);
  for (const char* wrong : {R"(, "height": 0)", R"(, "height": "1.7 m")", R"(, "unit": "yards")", R"(, "unit": -1)",
                            R"(, "rest": "t-pose")", R"(, "height": 1.7, "unit": "cm")", R"(, "size": 1.7)"})
    EXPECT_THROW(read(wrong), InputError) << wrong;

  SceneDescription scene = read(R"(, "unit": "cm", "rest": "node", "max_influences": 8)");
  write_scene(scene, folder / "t.json");
  const SceneDescription again = read_scene(folder / "t.json");
  EXPECT_EQ(again.import.metres_per_unit, 0.01);
  EXPECT_EQ(again.import.rest, rig::RestPose::node);
  EXPECT_EQ(again.import.max_influences, 8);
  EXPECT_EQ(again.character, folder / "a.dae");
}

TEST(SceneFile, AWindBlowsOnWhatHasAir) {
  const auto folder = scratch_folder();
  const std::string scene = write_small_scene(folder);
  const auto read = [&](const std::string& wind) {
    write_file(folder / "w.json",
               R"({"character": "body.dae", "motion": "small-motion.json", "garments": ["sheet.json"],
                                      "wind": )" +
                   wind + "}");
    return read_scene(folder / "w.json");
  };
  using ::testing::HasSubstr;
  const auto refused = [&](const std::string& wind) -> std::string {
    try {
      load_scene(read(wind));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(read_scene(scene).wind.is_still());
  const cloth::Wind wind = read(R"({"velocity": [3, 0, 1], "gusts": {"speed": 2, "period": 0.5}})").wind;
  EXPECT_EQ(wind, (cloth::Wind{{3, 0, 1}, cloth::Gusts{2, 0.5, 1}}));
  EXPECT_EQ(read(R"({"velocity": [3, 0, 1], "gusts": {"speed": 2, "period": 0.5, "seed": 9}})").wind.gusts->seed, 9u);
  EXPECT_THAT(refused("{}"), HasSubstr("velocity"));
  EXPECT_THAT(refused("3"), HasSubstr("/wind"));
  EXPECT_THAT(refused(R"({"velocity": [40, 40, 0]})"), HasSubstr("/wind/velocity: found 56.5685 m/s, expected a wind"));
  EXPECT_THAT(refused(R"({"velocity": [1, 0, 0], "turbulence": 1})"), HasSubstr("unknown key \"turbulence\""));
  EXPECT_THAT(refused(R"({"velocity": [1, 0, 0], "gusts": {"speed": 1}})"), HasSubstr("period"));
  EXPECT_THAT(refused(R"({"velocity": [1, 0, 0], "gusts": {"speed": 1, "period": 0}})"),
              HasSubstr("/wind/gusts/period: found 0"));
  EXPECT_THAT(refused(R"({"velocity": [1, 0, 0], "gusts": {"speed": 1, "period": 1, "seed": -1}})"),
              HasSubstr("/wind/gusts/seed: found -1"));
  EXPECT_THAT(refused(R"({"velocity": [1, 0, 0]})"),
              HasSubstr("/wind: found wind, and no garment whose fabric has air"));
  EXPECT_EQ(refused(R"({"velocity": [0, 0, 0]})"), "") << "none";

  write_file(folder / "sheet.json", R"({"shape": {"grid": {"rows": 9, "columns": 9, "corner": [-0.2, 0.84, -0.2],
      "across": [0.4, 0, 0], "down": [0, 0, 0.4]}}, "fabric": {"air": true}})");
  const auto fingerprint = [&](const std::string& more) { return drape_fingerprint(load_scene(read(more))); };
  const std::uint64_t still = fingerprint(R"({"velocity": [0, 0, 0]})");
  const std::uint64_t windy = fingerprint(R"({"velocity": [1, 0, 0]})");
  EXPECT_NE(still, windy);
  EXPECT_EQ(fingerprint(R"({"velocity": [1, 0, 0], "gusts": {"speed": 1, "period": 1}})"), windy)
      << "garments are draped without gusts";
  LoadedScene other = load_scene(read(R"({"velocity": [1, 0, 0]})"));
  EXPECT_EQ(other.wind, other.description().wind);
  other.garments[0].fabric.air->friction *= 2.0;
  EXPECT_NE(drape_fingerprint(other), windy);
  std::filesystem::remove_all(folder);
}

TEST(SceneFile, ReadsEveryFormOfMotion) {
  const auto folder = scratch_folder();
  for (const char* name : {"a.dae", "b.dae", "m.json", "t", "r", "k"}) write_file(folder / name, "");
  const auto read = [&](const std::string& motion) {
    write_file(folder / "s.json",
               R"({"character": {"file": "a.dae", "max_influences": 8}, "ground": false, "motion": )" + motion + "}");
    return read_scene(folder / "s.json");
  };
  EXPECT_EQ(std::get<ClipMotion>(read("\"m.json\"").motion).clip, folder / "m.json");
  EXPECT_EQ(*std::get<ClipMotion>(read(R"({"clip": "m.json", "retarget_from": "b.dae"})").motion).retarget_from,
            folder / "b.dae");
  EXPECT_EQ(std::get<int>(std::get<OwnMotion>(read(R"({"animation": 2})").motion).animation), 2);
  EXPECT_EQ(std::get<std::string>(std::get<OwnMotion>(read(R"({"animation": "jump"})").motion).animation), "jump");
  const SceneDescription texts = read(R"({"texts": {"translations": "t", "rotations": "r", "times": "k"}})");
  EXPECT_EQ(std::get<rig::ThreeTexts>(texts.motion).times, folder / "k");
  EXPECT_EQ(texts.import.max_influences, 8);
  EXPECT_FALSE(texts.ground_height.has_value());
  EXPECT_THROW(read(R"({"animation": 2, "clip": "m.json"})"), InputError);
  EXPECT_THROW(read(R"({"animation": 2, "retarget_from": "m.dae"})"), InputError);
  const MocapMotion mocap = std::get<MocapMotion>(
      read(R"({"bvh": "t", "rest_frame": 4, "from": 0.5, "to": 2, "joints": {"A": "Hips", "B": false}})").motion);
  EXPECT_EQ(mocap.bvh, folder / "t");
  EXPECT_EQ(mocap.options.rest_frame, 4);
  EXPECT_EQ(mocap.options.to, 2.0);
  EXPECT_EQ(mocap.joints.at("A"), "Hips");
  EXPECT_EQ(mocap.joints.at("B"), std::nullopt);
  EXPECT_THROW(read(R"({"bvh": "t", "joints": {"A": true}})"), InputError);
  EXPECT_THROW(read(R"({"bvh": "t", "from": 2, "to": 1})"), InputError);
  EXPECT_THROW(read("3"), InputError);
  std::filesystem::remove_all(folder);
}

TEST(SceneFile, InterpolationAndSkinningAreChosenInTheScene) {
  const auto folder = scratch_folder();
  const std::string dancer = source_file("assets/characters/dancer.dae").string(),
                    clip = source_file("assets/poses/dance.json").string();
  const auto load = [&](const std::string& more) {
    write_file(folder / "s.json", R"({"character": ")" + dancer + R"(", "motion": ")" + clip + "\"" + more + "}");
    return load_scene(read_scene(folder / "s.json"));
  };
  const LoadedScene plain = load(""), other = load(R"(, "interpolation": "cubic", "skinning": "dual_quaternion")");
  EXPECT_EQ(std::get<rig::Clip>(plain.motion).interpolation, rig::Interpolation::nlerp);
  EXPECT_EQ(plain.character.skin.method, rig::Skinning::linear);
  EXPECT_EQ(std::get<rig::Clip>(other.motion).interpolation, rig::Interpolation::cubic);
  EXPECT_EQ(other.character.skin.method, rig::Skinning::dual_quaternion);
  EXPECT_THROW(load(R"(, "interpolation": "linear")"), InputError);
  EXPECT_THROW(load(R"(, "skinning": "lbs")"), InputError);
  std::filesystem::remove_all(folder);
}

} // namespace
