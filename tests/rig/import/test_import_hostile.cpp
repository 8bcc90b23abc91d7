// Files that cannot become a character: one clear message, never a crash, never a hang.
#include "rig/character.h"
#include "rig/error.h"
#include "rig/import/import.h"
#include "rig/io/file_io.h"
#include "tests/rig/import/tiny_collada.h"
#include "tests/rig/import/tiny_glb.h"

#include <gmock/gmock.h>
#include <limits>
#include <random>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

/// The message, or "" when the file was read. Anything thrown but InputError fails the test.
std::string message_of(const fs::path& file) {
  try {
    const Import import = import_character(file);
    EXPECT_GT(import.character.mesh.vertex_count(), 0);
    return "";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.string()));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
}
std::string message_of(const TinyFile& file) { return message_of(write_text("tiny.dae", collada_text(file))); }

TEST(ImportHostile, FilesThatAreNone) {
  const fs::path folder = scratch_folder();
  EXPECT_THAT(message_of(folder / "none.dae"), HasSubstr("no such file"));
  fs::create_directory(folder / "folder.dae");
  EXPECT_THAT(message_of(folder / "folder.dae"), HasSubstr("not a file"));
  std::ofstream(folder / "empty.glb").close();
  EXPECT_THAT(message_of(folder / "empty.glb"), HasSubstr("an empty file"));
  std::ofstream(folder / "motion.bvh") << "HIERARCHY";
  EXPECT_THAT(message_of(folder / "motion.bvh"),
              HasSubstr("found a .bvh file, expected a rigged character: .dae, .gltf, .glb, .vrm, .fbx or .x"));
  std::ofstream(folder / "noise.fbx") << "noise";
  EXPECT_THAT(message_of(folder / "noise.fbx"), HasSubstr("cannot be read"));
  std::ofstream(folder / "other.dae") << read_file(assimp_model("OBJ/box.obj")); // another format under the name
  EXPECT_THAT(message_of(folder / "other.dae"), HasSubstr("cannot be read"));
  std::ofstream(folder / "device.gltf")
      << R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":8,"uri":"/dev/zero"}]})";
  EXPECT_NE(message_of(folder / "device.gltf"), "");
}

TEST(ImportHostile, OnlyTwoLimitsOfInfluences) {
  EXPECT_THROW(import_character(write_text("tiny.dae", collada_text(upright())), {.max_influences = 5}),
               std::invalid_argument);
}

TEST(ImportHostile, NoMeshNoSkinNoTriangles) {
  TinyFile file = upright();
  EXPECT_EQ(message_of(file), "");
  file.meshes[0].joints.clear();
  EXPECT_THAT(message_of(file), HasSubstr("found 1 mesh without a skin, expected a mesh bound to joints"));
  file.nodes.pop_back();
  file.meshes.clear();
  EXPECT_THAT(message_of(file), HasSubstr("found no mesh"));
  file = upright();
  file.meshes[0].triangles = {{0, 2, 2}};
  EXPECT_THAT(message_of(file), HasSubstr("no triangle"));
}

TEST(ImportHostile, WeightsOutOfRange) {
  TinyFile file = upright();
  file.meshes[0].weights[2] = {{0, -0.25}, {1, 1.25}};
  EXPECT_THAT(message_of(file), HasSubstr("skin of #body: found weight -0.25, expected a finite weight"));
  file.meshes[0].weights[2] = {{0, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THAT(message_of(file), HasSubstr("found weight nan"));
  file.meshes[0].weights[2] = {{7, 1.0}};
  EXPECT_THAT(message_of(file), HasSubstr("found joint index 7, expected an index below 2"));
  file.meshes[0].weights[2] = {{-1, 1.0}};
  EXPECT_THAT(message_of(file), HasSubstr("found joint index -1"));
  file.meshes[0].weights = std::vector<std::vector<std::pair<int, double>>>(4);
  EXPECT_NE(message_of(file), "");
}

TEST(ImportHostile, WeightsOutOfRangeInGltf) {
  const auto message = [](const std::string& bytes) { return message_of(write_text("tiny.glb", bytes)); };
  EXPECT_EQ(message(tiny_glb()), "");
  EXPECT_THAT(message(tiny_glb({.last_weight = -0.5f})), HasSubstr("found weight -0.5"));
  EXPECT_THAT(message(tiny_glb({.last_weight = std::numeric_limits<float>::quiet_NaN()})),
              HasSubstr("found weight nan"));
  EXPECT_THAT(message(tiny_glb({.last_joint = 9})),
              HasSubstr("found joint index 9 for vertex 2, expected an index below 2"));
  EXPECT_NE(message(tiny_glb({.last_index = 77})), "");
  EXPECT_NE(message(tiny_glb({.last_height = std::numeric_limits<float>::infinity()})), "");
}

TEST(ImportHostile, BrokenReferences) {
  TinyFile file = upright();
  file.meshes[0].triangles[1] = {2, 1, 99};
  EXPECT_NE(message_of(file), "");
  file = upright();
  file.meshes[0].joints[1] = "Nobody";
  EXPECT_THAT(message_of(file), HasSubstr("bone Nobody: found a bone without a node of its name"));
}

TEST(ImportHostile, NumbersOutOfMeasure) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {infinity, nan, 3e38}) {
    TinyFile file = upright();
    file.meshes[0].positions[2].y() = bad;
    EXPECT_NE(message_of(file), "") << "position " << bad;
    file = upright();
    file.meshes[0].inverse_binds[0](1, 1) = bad;
    EXPECT_NE(message_of(file), "") << "inverse bind " << bad;
    file = upright();
    file.nodes[0].children[0].matrix(0, 0) = bad;
    EXPECT_NE(message_of(file), "") << "node " << bad;
  }
  TinyFile file = upright();
  file.meshes[0].inverse_binds = {scaled(0), scaled(0)};
  EXPECT_NE(message_of(file), "");
  file = upright();
  file.unit = 0;
  message_of(file); // whatever it is, no crash
  file = upright();
  for (Vec3& p : file.meshes[0].positions) p *= 1e9;
  EXPECT_THAT(message_of(file), HasSubstr("a position out of all measure"));
}

TEST(ImportHostile, InvalidModelsOfAssimp) {
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(assimp_model("invalid"))) {
    ++seen;
    EXPECT_NE(message_of(entry.path()), "") << entry.path();
    for (const char* extension : {".dae", ".gltf", ".glb", ".fbx", ".x"}) { // and under each name we accept
      const fs::path copy = scratch_folder() / ("copy" + std::string(extension));
      fs::copy_file(entry.path(), copy);
      EXPECT_NE(message_of(copy), "") << entry.path() << " as " << extension;
    }
  }
  EXPECT_GT(seen, 10);
}

TEST(ImportHostile, EveryModelOfAssimp) {
  std::vector<std::string> read;
  for (const auto& entry : fs::recursive_directory_iterator(assimp_model("")))
    if (entry.is_regular_file() && message_of(entry.path()).empty()) read.push_back(entry.path().filename());
  EXPECT_THAT(read, ::testing::UnorderedElementsAre("BCN_Epileptic.X", "Testwuson.X", "test_cube_text.x",
                                                    "test_cube_binary.x", "test_cube_compressed.x",
                                                    "animation_with_skeleton.fbx", "huesitos.fbx", "simple_skin.gltf",
                                                    "box_nested_animation.dae"));
}

struct Case {
  const char* extension;
  std::string bytes;
};
std::vector<Case> good_files() {
  TinyFile animated = upright();
  animated.tracks = {{"Hips-1", {0, 1}, {moved(0, 1, 0), moved(1, 1, 0)}}};
  return {{".dae", collada_text(animated)},
          {".glb", tiny_glb()},
          {".x", read_file(assimp_model("X/test_cube_text.x"))},
          {".fbx", read_file(assimp_model("FBX/huesitos.fbx"))}};
}

TEST(ImportHostile, TruncatedAnywhere) {
  for (const Case& good : good_files()) {
    const fs::path file = scratch_folder() / ("cut" + std::string(good.extension));
    const auto try_bytes = [&](std::string_view bytes) {
      std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
      return message_of(file);
    };
    EXPECT_EQ(try_bytes(good.bytes), "") << good.extension;
    for (std::size_t i = 0; i < 50; ++i) try_bytes(std::string_view(good.bytes).substr(0, good.bytes.size() * i / 50));
    EXPECT_NE(try_bytes(std::string_view(good.bytes).substr(0, good.bytes.size() / 3)), "") << good.extension;
  }
}

TEST(ImportHostile, FlippedBytes_slow) {
  std::mt19937_64 random(5);
  for (const Case& good : good_files()) {
    const fs::path file = scratch_folder() / ("flip" + std::string(good.extension));
    int refused = 0;
    for (int i = 0; i < 200; ++i) {
      std::string bytes = good.bytes;
      for (int flips = 1 + i % 4; flips > 0; --flips) {
        char& byte = bytes[random() % bytes.size()];
        byte = static_cast<char>(byte ^ static_cast<char>(1 + random() % 255));
      }
      std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
      refused += message_of(file).empty() ? 0 : 1;
    }
    EXPECT_GT(refused, 20) << good.extension; // the flips do damage
    EXPECT_LT(refused, 200) << good.extension;
  }
}

} // namespace
