// The reader of glTF against an evaluator written from the specification: every way of storing one body, and every
// model at hand.
#include "rig/error.h"
#include "rig/import/gltf/gltf.h"
#include "tests/rig/import/gltf/compare_twin.h"
#include "tests/rig/import/gltf/gltf_body.h"
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

struct Kind {
  const char* name;
  BodyOptions options;
  double loss = 1e-6; ///< m, at most, to the same body in plain floats
  bool meshopt = false;
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

constexpr Stored k_byte{.component = k_int8, .normalized = true}, k_short{.component = k_int16, .normalized = true};

const std::vector<Kind> k_kinds = {
    {"plain", {}},
    {"rotations_byte", {.rotations = k_byte}, 0.02},
    {"rotations_short", {.rotations = k_short}, 1e-4},
    {"weights_byte", {.weights = {.component = k_uint8, .normalized = true}}, 0.005},
    {"weights_short", {.weights = {.component = k_uint16, .normalized = true}}, 1e-4},
    {"joints_short_indices_int", {.joints = k_uint16, .indices = k_uint32}},
    {"indices_byte", {.indices = k_uint8}},
    {"interleaved", {.positions = {.gap = 8}, .weights = {.gap = 4}}},
    {"sparse", {.positions = {.is_sparse = true}, .rotations = {.is_sparse = true}}},
    {"quantized_short", {.positions = {.component = k_int16, .normalized = true, .gap = 2}, .quantized = true}, 1e-4},
    {"quantized_whole", {.positions = {.component = k_int16, .gap = 2}, .quantized = true}, 1e-3},
    {"quantized_byte", {.positions = {.component = k_int8, .normalized = true, .gap = 1}, .quantized = true}, 0.03},
    {"step", {.law = "STEP"}, 3.0},
    {"cubic", {.law = "CUBICSPLINE"}, 3.0},
    {"no_indices", {.has_indices = false}},
    {"strip", {.mode = 5}, 3.0},
    {"fan", {.mode = 6}, 3.0},
    {"strip_without_indices", {.has_indices = false, .mode = 5}, 3.0},
    {"two_sets", {.second_set = true}},
    {"children_first", {.children_first = true}},
    {"matrices", {.matrices = true}},
    {"morph", {.morph = 0.75}, 0.2},
    {"morph_sparse_without_bytes", {.morph = 1.0, .sparse_morph = true}, 0.25},
    {"no_inverse_binds", {.has_inverse_binds = false}, 3.0},
    {"draco_sequential", {.draco = draco::MESH_SEQUENTIAL_ENCODING}},
    {"draco_edgebreaker", {.draco = draco::MESH_EDGEBREAKER_ENCODING}},
    {"draco_weights_byte",
     {.weights = {.component = k_uint8, .normalized = true}, .draco = draco::MESH_SEQUENTIAL_ENCODING},
     0.005},
    {"meshopt", {}, 1e-6, true},
    {"meshopt_quantized",
     {.positions = {.component = k_int16, .normalized = true, .gap = 2},
      .weights = {.component = k_uint8, .normalized = true},
      .quantized = true},
     0.005,
     true},
    {"meshopt_filters",
     {.normals = {.component = k_int16, .normalized = true, .filter = "OCTAHEDRAL"},
      .rotations = {.component = k_int16, .normalized = true, .filter = "QUATERNION"},
      .translations = {.filter = "EXPONENTIAL"}},
     1e-4,
     true},
    {"meshopt_strip", {.indices = k_uint32, .mode = 5}, 3.0, true},
    {"meshopt_sparse", {.positions = {.is_sparse = true}}, 1e-6, true},
};

class GltfKinds : public ::testing::TestWithParam<Kind> {};

TEST_P(GltfKinds, AreReadAsTheSpecificationHasThem) {
  const Kind& kind = GetParam();
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

INSTANTIATE_TEST_SUITE_P(All, GltfKinds, ::testing::ValuesIn(k_kinds),
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

/// Every model of these folders that has a skin, or draws anything at all.
std::vector<fs::path> models_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(GltfTwins, ModelsOfAssimp) {
  int compared = 0;
  for (const fs::path& file : models_in(assimp_model("glTF2"))) {
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
  std::vector<fs::path> files = models_in(characters);
  for (const fs::path& file : models_in(cases)) files.push_back(file);
  if (files.empty()) GTEST_SKIP() << "no characters beside the checkout";
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    if (file.filename() == "10c-meshopt.glb") continue;    // its streams are none
    if (GltfTwin(file).corners(-1, 0.0).empty()) continue; // motion alone
    EXPECT_LT(difference(file), k_close);
  }
}

} // namespace
