// Characters from glTF against the twin: the body that stands and dances behind the importer is the one the
// specification has.
#include "rig/error.h"
#include "rig/import/import.h"
#include "tests/rig/import/gltf/compare_twin.h"
#include "tests/rig/import/gltf/gltf_kinds.h"
#include "tests/rig/import/tiny_collada.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

namespace {

Import import_as_nodes_stand(const fs::path& file) {
  return import_character(file, {.max_influences = 8, .rest = RestPose::node});
}

/// Corners of all triangles at a time of a clip, or at rest.
std::vector<Vec3> corners_of(const Import& import, int clip, double time) {
  const Character& c = import.character;
  std::vector<Transform> local(c.skeleton.rest_local), model(local.size());
  if (clip >= 0) {
    ChannelClip once = import.clips.at(static_cast<std::size_t>(clip));
    once.extrapolation = Extrapolation::clamp;
    sample(once, time, local);
  }
  model_from_local(c.skeleton, local, model);
  const std::vector<Vec3> points = skinned(c, model);
  std::vector<Vec3> corners;
  for (const Triangle& triangle : c.mesh.triangles)
    for (const std::uint32_t v : triangle) corners.push_back(points[v]);
  return corners;
}

double difference(const fs::path& file, const Import& import) {
  GltfTwin twin(file);
  EXPECT_EQ(import.clips.size(), twin.animations());
  return difference(
      twin, [&](int clip, double time) { return corners_of(import, clip, time); }, farthest_point);
}

/// A joint has no scale of its own: what an animation says of it is noted, not done.
void leave_scale_out(GltfMaker& maker) {
  for (nlohmann::json& animation : maker.root["animations"]) {
    auto& channels = animation["channels"];
    channels.erase(std::remove_if(channels.begin(), channels.end(),
                                  [](const nlohmann::json& c) { return c["target"]["path"] == "scale"; }),
                   channels.end());
  }
}

class GltfCharacters : public ::testing::TestWithParam<GltfKind> {};

TEST_P(GltfCharacters, DanceAsTheSpecificationHasThem) {
  const GltfKind& kind = GetParam();
  GltfBody body(kind.options);
  body.maker.meshopt = kind.meshopt;
  leave_scale_out(body.maker);
  const fs::path file = GltfMaker::write(scratch_folder() / "body.glb", body.maker.glb());
  EXPECT_LT(difference(file, import_as_nodes_stand(file)), k_close);
}

INSTANTIATE_TEST_SUITE_P(All, GltfCharacters, ::testing::ValuesIn(k_gltf_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(GltfImport, EveryModelWithASkin) {
  int compared = 0;
  std::vector<fs::path> files = gltf_models_in(assimp_model("glTF2"));
  for (const fs::path& file : gltf_models_in(human(""))) files.push_back(file);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    std::optional<Import> import;
    try {
      if (!GltfTwin(file).has_skin()) continue;
      import = import_as_nodes_stand(file);
    } catch (const InputError&) {
      continue; // test_gltf_hostile.cpp knows them
    }
    const double largest = difference(file, *import);
    std::printf("%s: %.3f m, %d joints, %zu clips, %.1e of the height from the twin\n", file.filename().c_str(),
                import->report.height, import->character.skeleton.joint_count(), import->clips.size(), largest);
    EXPECT_LT(largest, k_close);
    ++compared;
  }
  EXPECT_GE(compared, 2);
}

/// Its node of the right arm, turned.
void add_prop(GltfBody& body, const char* name) {
  GltfMaker& maker = body.maker;
  const int points = maker.add_accessor({0, 0, 0, 0.1, 5, 0, 0, 5, 0.1}, "VEC3");
  const int mesh = maker.add("meshes", {{"name", "spear"}, {"primitives", {{{"attributes", {{"POSITION", points}}}}}}});
  const int prop = maker.add("nodes", {{"name", name}, {"mesh", mesh}});
  maker.root["nodes"][static_cast<std::size_t>(body.joint(4))]["children"].push_back(prop);
  const int times = maker.add_accessor({0, 2}, "SCALAR"), turns = maker.add_accessor({0, 0, 0, 1, 1, 0, 0, 0}, "VEC4");
  nlohmann::json& animation = maker.root["animations"][0];
  animation["samplers"].push_back({{"input", times}, {"output", turns}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", prop}, {"path", "rotation"}}}});
}

TEST(GltfImport, APropIsNoJointAndSaysNothingOfTheBodysHeight) {
  GltfBody with({}), without({});
  add_prop(with, "RightArm"); // the name of a joint
  const fs::path folder = scratch_folder();
  const Import import = import_character(GltfMaker::write(folder / "with.glb", with.maker.glb())),
               plain = import_character(GltfMaker::write(folder / "without.glb", without.maker.glb()));
  EXPECT_NEAR(import.report.height, GltfBody::k_height, 1e-6);
  EXPECT_EQ(import.report.metres_per_unit, 1.0);
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("spear (on RightHand)")));
  ASSERT_EQ(import.clips.size(), 1u);
  const auto joint = [](const Import& from) { return *from.character.skeleton.find("RightArm"); };
  std::vector<Transform> a(import.character.skeleton.rest_local), b(plain.character.skeleton.rest_local);
  for (const double time : {0.0, 0.7, 1.6}) {
    sample(import.clips[0], time, a);
    sample(plain.clips[0], time, b);
    EXPECT_LT(a[joint(import)].rotation.angularDistance(b[joint(plain)].rotation), 1e-9) << time;
  }
}

TEST(GltfImport, TwoJointsOfOneNameAreTwo) {
  GltfBody body({});
  for (const int j : {3, 5}) body.maker.root["nodes"][static_cast<std::size_t>(body.joint(j))]["name"] = "Arm";
  const Import import = import_character(GltfMaker::write(scratch_folder() / "body.glb", body.maker.glb()));
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("Hips", "Spine", "Head", "Arm", "RightHand", "Arm_2"));
  ASSERT_EQ(import.clips.size(), 1u);
  std::vector<Transform> local(import.character.skeleton.rest_local);
  sample(import.clips[0], 1.25, local);
  EXPECT_GT(local[3].rotation.angularDistance(import.character.skeleton.rest_local[3].rotation), 1.0) << "it waves";
  EXPECT_LT(local[5].rotation.angularDistance(import.character.skeleton.rest_local[5].rotation), 1e-9) << "not this";
}

TEST(GltfImport, RestsInItsBindPoseQuantisedOrNot) {
  const Stored stored{.component = k_int16, .normalized = true, .gap = 2};
  std::vector<Vec3> bones[2];
  for (const bool quantised : {false, true}) {
    GltfBody body(quantised ? BodyOptions{.positions = stored, .quantized = true} : BodyOptions{});
    nlohmann::json& nodes = body.maker.root["nodes"]; // in a leap, one arm down
    nodes[static_cast<std::size_t>(body.joint(0))]["translation"] = {0.3, 1.6, 0.2};
    nodes[static_cast<std::size_t>(body.joint(3))]["rotation"] = {0, 0, std::sin(0.6), std::cos(0.6)};
    const Import import = import_character(GltfMaker::write(scratch_folder() / "body.glb", body.maker.glb()));
    EXPECT_THAT(import.report.notes, Contains(HasSubstr("rests in its bind pose")));
    EXPECT_NEAR(import.report.height, GltfBody::k_height, 1e-3);
    const auto rest = rest_model(import.character.skeleton);
    for (const Transform& joint : rest) bones[quantised].push_back(joint.translation - rest[0].translation);
    EXPECT_NEAR(rest[4].translation.y(), rest[3].translation.y(), 1e-4) << "the arm is level";
  }
  for (std::size_t j = 0; j < bones[0].size(); ++j) EXPECT_LT((bones[0][j] - bones[1][j]).norm(), 1e-4) << j;
}

TEST(GltfImport, WithoutInverseBindsRestsAsItsNodesStand) {
  const GltfBody body({.has_inverse_binds = false});
  const Import import = import_character(GltfMaker::write(scratch_folder() / "body.glb", body.maker.glb()));
  EXPECT_EQ(import.character.skeleton.joint_count(), 6);
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("say nothing of a bind pose")));
}

TEST(GltfImport, NotesOfAnAnimationNameIt) {
  GltfBody body({.morph = 0.5});
  GltfMaker& maker = body.maker;
  const int times = maker.add_accessor({0, 1}, "SCALAR"), weights = maker.add_accessor({0, 1}, "SCALAR");
  nlohmann::json& animation = maker.root["animations"][0];
  animation["samplers"].push_back({{"input", times}, {"output", weights}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", body.body_node}, {"path", "weights"}}}});
  const Import import = import_character(GltfMaker::write(scratch_folder() / "body.glb", maker.glb()));
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("animation wave: it animates the weights of morph targets")));
}

TEST(GltfImport, AVrmIsReadAsWhatItIs) {
  GltfBody body({});
  body.maker.root["extensionsUsed"] = {"VRM"};
  body.maker.root["extensions"]["VRM"] = {{"specVersion", "0.0"}};
  const Import import = import_character(GltfMaker::write(scratch_folder() / "body.vrm", body.maker.glb()));
  EXPECT_EQ(import.report.format, "VRM 0.x");
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("faces -Z")));
}

} // namespace
