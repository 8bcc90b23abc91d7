// What a scene's files describe is held against the limit of memory before it is built, and is told of its file.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"
#include "tests/support/peak_memory.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;
using ::testing::HasSubstr;

namespace {

constexpr const char* k_variable = "TUTU_MEMORY_GIB";

class SceneMemory : public ::testing::Test {
protected:
  void SetUp() override { scene_ = write_small_scene(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void garments(const std::string& list) const {
    write_file(scene_, R"({"character": "body.dae", "motion": "small-motion.json", "proxies": "proxies.json",
                          "garments": [)" +
                           list + "]}");
  }
  void sheet(const std::string& name, int rows, int columns) const {
    write_file(path(name), R"({"shape": {"grid": {"rows": )" + std::to_string(rows) + R"(, "columns": )" +
                               std::to_string(columns) +
                               R"(, "corner": [-0.2, 0.84, -0.2], "across": [0.4, 0, 0], "down": [0, 0, 0.4]}}})");
  }
  InputError refusal() const {
    const double before = memory_now("VmRSS");
    try {
      load_scene(read_scene(scene_));
    } catch (const InputError& error) {
      EXPECT_LT(memory_now("VmRSS") - before, 64e6) << "nothing was allocated for it";
      return error;
    }
    ADD_FAILURE() << "loaded";
    return {"", "", "", ""};
  }

  std::filesystem::path folder_ = scratch_folder();
  std::string scene_;
};

TEST_F(SceneMemory, AResolutionThatIsTooFineIsToldOfTheScene) {
  const Variable none(k_variable, nullptr);
  garments(R"("sheet.json", {"file": "sheet.json", "resolution": 100})");
  EXPECT_EQ(load_scene(read_scene(scene_)).garments[1].particle_count(), 801 * 801) << "what is below the limit is not";
  sheet("fine.json", 60, 60);
  garments(R"("sheet.json", {"file": "fine.json", "resolution": 100})");
  const InputError error = refusal();
  EXPECT_EQ(error.file(), scene_);
  EXPECT_EQ(error.place(), "/garments/1/resolution");
  EXPECT_THAT(error.found(), HasSubstr("a garment of 34,821,801 particles, about 31.1 GiB"));
  EXPECT_EQ(error.expected(), "at most 2 GiB; TUTU_MEMORY_GIB=32 raises the limit");
}

TEST_F(SceneMemory, AGarmentThatIsTooLargeIsToldOfItsOwnFile) {
  const Variable small(k_variable, "1");
  sheet("huge.json", 4096, 4096);
  garments(R"("huge.json")");
  const InputError error = refusal();
  EXPECT_EQ(error.file(), path("huge.json"));
  EXPECT_EQ(error.place(), "/shape/grid");
  EXPECT_EQ(error.found(), "a garment of 16,777,216 particles, about 15 GiB");
  EXPECT_EQ(error.expected(), "at most 1 GiB; TUTU_MEMORY_GIB=15 raises the limit");
  garments(R"({"file": "huge.json", "resolution": 0.01})");
  EXPECT_EQ(load_scene(read_scene(scene_)).garments[0].particle_count(), 42 * 42) << "few of it is not too large";
}

TEST_F(SceneMemory, SoAreGarmentsThatAreTooLargeTogether) {
  sheet("a.json", 100, 100);
  garments(R"("a.json", "a.json", "a.json", "a.json")");
  const Variable small(k_variable, "0.02");
  const InputError error = refusal();
  EXPECT_EQ(error.file(), scene_);
  EXPECT_EQ(error.place(), "/garments/2");
  EXPECT_THAT(error.found(), HasSubstr("3 garments of 30,000 particles up to here"));
}

TEST_F(SceneMemory, ProxiesBesideAFineGarment) {
  sheet("a.json", 600, 600);
  garments(R"("a.json")");
  std::string proxies = R"({"proxies": [)";
  for (int k = 0; k < 3000; ++k)
    proxies += std::string(k > 0 ? "," : "") + R"({"name": "p)" + std::to_string(k) +
               R"(", "sphere": {"joint": "Hips", "center": [0, 0, 0], "radius": 0.1}})";
  write_file(path("proxies.json"), proxies + "]}");
  const Variable small(k_variable, "0.4");
  const InputError error = refusal();
  EXPECT_EQ(error.file(), scene_);
  EXPECT_EQ(error.place(), "/proxies");
  EXPECT_THAT(error.found(), HasSubstr("3,000 of them beside 360,000 particles"));
}

TEST_F(SceneMemory, AClipOfMorePosesThanThereIsRoomFor) {
  std::string keys = R"({"keys": [)";
  for (int k = 0; k < 20000; ++k) keys += std::string(k > 0 ? "," : "") + R"({"time": )" + std::to_string(k) + "}";
  write_file(path("small-motion.json"), keys + "]}");
  write_file(scene_, R"({"character": ")" + source_file("assets/characters/dancer.dae").string() +
                         R"(", "motion": "small-motion.json"})");
  for (const auto& [gib, found] : {std::pair("0.05", "20,000 poses of 52 joints, about 0.1"), {"0.001", "JSON of "}}) {
    const Variable small(k_variable, gib); // the text is small, the poses are not
    const InputError error = refusal();
    EXPECT_EQ(error.file(), path("small-motion.json"));
    EXPECT_THAT(error.found(), HasSubstr(found));
  }
}

TEST_F(SceneMemory, ChannelsThatWouldMakeMoreKeyPosesThanThereIsRoomFor) {
  std::string times, values, text = read_file(source_file("assets/characters/dancer.dae"));
  for (int k = 0; k < 4000; ++k) {
    times += std::to_string(k) + " ";
    values += k % 2 ? "1 " : "0 ";
  }
  const auto source = [](const std::string& id, const std::string& numbers) {
    return "<source id=\"" + id + "\"><float_array id=\"" + id + "-a\" count=\"4000\">" + numbers +
           "</float_array><technique_common><accessor source=\"#" + id +
           "-a\" count=\"4000\"><param type=\"float\"/></accessor></technique_common></source>";
  };
  const std::string animation =
      "<library_animations><animation>" + source("in", times) + source("out", values) +
      R"(<sampler id="s"><input semantic="INPUT" source="#in"/><input semantic="OUTPUT")" +
      R"x( source="#out"/></sampler><channel source="#s" target="mixamorig_Hips/transform(3)(0)"/>)x" +
      "</animation></library_animations>";
  text.insert(text.find("<library_visual_scenes"), animation);
  write_file(path("moved.dae"), text);
  const auto scene = [&](const std::string& more) {
    write_file(scene_, R"({"character": "moved.dae", "motion": {"animation": 0})" + more + "}");
  };
  const Variable small(k_variable, "0.05");
  scene("");
  EXPECT_NO_THROW(load_scene(read_scene(scene_))) << "the channels themselves are small";
  scene(R"(, "interpolation": "slerp")");
  const InputError error = refusal();
  EXPECT_EQ(error.file(), path("moved.dae"));
  EXPECT_THAT(error.found(), HasSubstr(" poses of 52 joints"));
}

TEST_F(SceneMemory, AVariableThatSaysNothingIsTold) {
  const Variable bad(k_variable, "lots");
  EXPECT_EQ(refusal().file(), "$TUTU_MEMORY_GIB");
}

} // namespace
