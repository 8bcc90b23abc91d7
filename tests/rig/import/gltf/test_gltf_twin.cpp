// The reader of glTF against an evaluator written from the specification: every way of storing one body, and every
// model at hand.
#include "rig/error.h"
#include "rig/import/gltf/gltf.h"
#include "tests/rig/import/gltf/compare_twin.h"
#include "tests/rig/import/gltf/gltf_kinds.h"
#include "tests/rig/import/gltf/scene_corners.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::test;
using rig::import_detail::FileScene;
using rig::import_detail::read_gltf;
namespace fs = std::filesystem;

namespace {

double difference(const fs::path& file) {
  GltfTwin twin(file);
  const FileScene scene = read_gltf(file);
  EXPECT_EQ(scene.animations.size(), twin.animations());
  for (std::size_t a = 0; a < scene.animations.size(); ++a) {
    EXPECT_EQ(scene.animations[a].start, 0.0);
    EXPECT_EQ(scene.animations[a].end, twin.end_of(a));
  }
  return difference(twin, [&](int animation, double time) { return scene_corners(scene, animation, time); });
}

class GltfKinds : public ::testing::TestWithParam<GltfKind> {};

TEST_P(GltfKinds, AreReadAsTheSpecificationHasThem) {
  const GltfKind& kind = GetParam();
  GltfBody body(kind.options);
  body.maker.meshopt = kind.meshopt;
  const fs::path folder = scratch_folder();
  const fs::path glb = GltfMaker::write(folder / "body.glb", body.maker.glb()),
                 gltf = GltfMaker::write(folder / "body.gltf", body.maker.gltf());
  EXPECT_LT(difference(glb), k_close);
  EXPECT_LT(difference(gltf), k_close);

  // And it is the body: not only the same to two who call one library.
  if (kind.loss > 1.0) return;
  const fs::path plain = GltfMaker::write(folder / "plain.glb", GltfBody({}).maker.glb());
  const FileScene scene = read_gltf(glb), known = read_gltf(plain);
  for (const double time : {0.0, 0.4, 1.1, 1.9})
    EXPECT_LE(farthest_triangle(scene_corners(scene, 0, time), scene_corners(known, 0, time)), kind.loss) << time;
}

INSTANTIATE_TEST_SUITE_P(All, GltfKinds, ::testing::ValuesIn(k_gltf_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(GltfTwins, SeeADifference) {
  const fs::path folder = scratch_folder();
  const fs::path file = GltfMaker::write(folder / "body.glb", GltfBody({}).maker.glb());
  GltfTwin twin(file);
  FileScene scene = read_gltf(file);
  const Reading reading = [&](int animation, double time) { return scene_corners(scene, animation, time); };
  EXPECT_LT(difference(twin, reading), k_close);
  EXPECT_LT(difference(twin, reading, farthest_point), k_close);
  scene.animations[0].nodes[0].translation.values[1].x() += 1e-4;
  EXPECT_GT(difference(twin, reading), k_close);
  EXPECT_GT(difference(twin, reading, farthest_point), k_close);
}

TEST(GltfTwins, ModelsOfAssimp) {
  int compared = 0;
  for (const fs::path& file : gltf_models_in(assimp_model("glTF2"))) {
    SCOPED_TRACE(file);
    try {
      const FileScene scene = read_gltf(file);
      if (scene.instances.empty() || scene_corners(scene, -1, 0.0).empty()) continue;
    } catch (const InputError&) {
      continue; // test_gltf_hostile.cpp knows them
    }
    EXPECT_LT(difference(file), k_close);
    ++compared;
  }
  EXPECT_GE(compared, 20);
}

TEST(GltfTwins, FilesBesideTheCheckout) {
  const fs::path characters = human(""), cases = characters.parent_path().parent_path() / "cases";
  std::vector<fs::path> files = gltf_models_in(characters);
  for (const fs::path& file : gltf_models_in(cases)) files.push_back(file);
  if (files.empty()) GTEST_SKIP() << "no characters beside the checkout";
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    if (file.filename() == "10c-meshopt.glb") continue;    // its streams are none
    if (GltfTwin(file).corners(-1, 0.0).empty()) continue; // motion alone
    EXPECT_LT(difference(file), k_close);
  }
}

} // namespace
