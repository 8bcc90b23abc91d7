// The importer on real characters.
#include "rig/character.h"
#include "rig/import/import.h"
#include "tests/rig/import/tiny_collada.h"

#include <gmock/gmock.h>
#include <map>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;
using ::testing::Contains;
using ::testing::IsEmpty;

namespace {

TEST(ImportModels, AnimatedHumanOfDirectX) {
  const Import import = import_character(assimp_model("X/BCN_Epileptic.X"));
  const Character& c = import.character;
  EXPECT_EQ(c.skeleton.joint_count(), 54);
  EXPECT_THAT(c.skeleton.names, Contains("B_Knee_Left"));
  EXPECT_NEAR(import.report.height, 1.814, 0.001);
  EXPECT_EQ(import.report.up_axis, "Y");
  ASSERT_EQ(c.mesh.parts.size(), 3u);
  EXPECT_EQ(c.mesh.parts[0].name, "Torso");
  EXPECT_EQ(c.skin.slot_count(), 54); // three meshes, one bind
  ASSERT_EQ(import.clips.size(), 1u);
  EXPECT_EQ(import.clips[0].name, "Epileptisch");
  EXPECT_EQ(key_times(import.clips[0]).size(), 100u);
  EXPECT_NEAR(import.clips[0].end, 3.3, 1e-6);
  const auto rest = rest_model(c.skeleton);
  const Vec3 toe =
      rest[*c.skeleton.find("B_Toe_Left")].translation - rest[*c.skeleton.find("B_Ankle_Left")].translation;
  EXPECT_GT(toe.z(), 0.1); // it faces +Z
}

TEST(ImportModels, FbxInCentimetresWithScaledArmature) {
  const Import import = import_character(assimp_model("FBX/huesitos.fbx"));
  EXPECT_EQ(import.character.skeleton.joint_count(), 11);
  EXPECT_EQ(import.character.skeleton.names[0], "Bone");
  ASSERT_EQ(import.clips.size(), 1u);
  // Bound at rest: every slot is the inverse of its joint at rest.
  const auto rest = rest_model(import.character.skeleton);
  const Skin& skin = import.character.skin;
  for (int s = 0; s < skin.slot_count(); ++s)
    EXPECT_LT((skin.inverse_bind[s].translation() - rest[skin.slot_joint[s]].inverse().translation).norm(), 1e-12);
}

TEST(ImportModels, AWolfAlongZStandsOnY) {
  EXPECT_EQ(import_character(assimp_model("X/Testwuson.X")).report.up_axis, "Y");
}

TEST(ImportModels, Humans) {
  if (!exists(human("human-female.dae"))) GTEST_SKIP() << "no human test characters beside the checkout";
  const std::pair<const char*, double> cases[] = {
      {"human-female.dae", 1.605}, {"human-female.glb", 1.605}, {"human-male.dae", 1.748}};
  for (const auto& [name, height] : cases) {
    const Import import = import_character(human(name));
    EXPECT_NEAR(import.report.height, height, 0.001) << name;
    EXPECT_EQ(import.character.skeleton.joint_count(), 52) << name;
    EXPECT_EQ(import.character.mesh.vertex_count(), 13380) << name;
    EXPECT_EQ(import.character.mesh.triangles.size(), 26756u) << name;
    EXPECT_EQ(import.character.skin.slot_count(), 52) << name;
    EXPECT_EQ(import.report.joints_without_weight, 0) << name;
  }
}

TEST(ImportModels, OneHumanInTwoFormats) {
  if (!exists(human("human-female.dae"))) GTEST_SKIP() << "no human test characters beside the checkout";
  const Character collada = import_character(human("human-female.dae"), {.max_influences = 8}).character;
  const Character gltf = import_character(human("human-female.glb"), {.max_influences = 8}).character;
  ASSERT_EQ(collada.skeleton.joint_count(), gltf.skeleton.joint_count());
  const auto rest_a = rest_model(collada.skeleton), rest_b = rest_model(gltf.skeleton);
  for (int j = 0; j < collada.skeleton.joint_count(); ++j) {
    const auto other = gltf.skeleton.find(bare_joint_name(collada.skeleton.names[j]));
    ASSERT_TRUE(other) << collada.skeleton.names[j];
    EXPECT_LT((rest_a[j].translation - rest_b[*other].translation).norm(), 1e-5);
    EXPECT_LT(rest_a[j].rotation.angularDistance(rest_b[*other].rotation), 1e-4);
  }
  // The same points at rest, whatever their order.
  const auto cell = [](const Vec3& p) {
    return std::array{std::lround(p.x() * 1e4), std::lround(p.y() * 1e4), std::lround(p.z() * 1e4)};
  };
  std::multimap<std::array<long, 3>, Vec3> grid;
  for (const Vec3& p : skinned(gltf, rest_b)) grid.emplace(cell(p), p);
  std::size_t missing = 0;
  for (const Vec3& p : skinned(collada, rest_a)) {
    double nearest = 1.0;
    const auto centre = cell(p);
    for (long x = -1; x <= 1; ++x)
      for (long y = -1; y <= 1; ++y)
        for (long z = -1; z <= 1; ++z) {
          const auto [begin, end] = grid.equal_range({centre[0] + x, centre[1] + y, centre[2] + z});
          for (auto other = begin; other != end; ++other) nearest = std::min(nearest, (other->second - p).norm());
        }
    missing += nearest > 1e-5 ? 1 : 0;
  }
  EXPECT_EQ(missing, 0u);
}

} // namespace
