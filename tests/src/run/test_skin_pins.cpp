// Garments held by the skin.
#include "rig/io/file_io.h"
#include "src/run/session.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

/// The dance, with a small skirt whose waist is held by the skin and whose second row is not.
class SkinPinsTest : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    folder_ = std::filesystem::temp_directory_path() / ("tutu-skin-pins." + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    write_file(folder_ / "skirt.json", R"({"name": "skirt",
      "shape": {"tube": {"rows": 8, "columns": 24, "rings": [
        {"height": 1.06, "radius": [0.127, 0.087], "centre": [0, 0.005]},
        {"height": 0.88, "radius": [0.205, 0.150], "centre": [0, -0.01]},
        {"height": 0.70, "radius": [0.35, 0.31], "centre": [0, -0.01]}]}},
      "fabric": {"stretch": 200}, "attachments": [{"skin": true, "rows": 0}]})");
    const std::string assets = source_file("assets").string();
    write_file(folder_ / "scene.json", R"({"character": ")" + assets + R"(/characters/dancer.dae", "motion": ")" +
                                           assets + R"(/poses/dance.json", "proxies": ")" + assets +
                                           R"(/proxies/dancer.json", "garments": ["skirt.json"]})");
    scene_ = new LoadedScene(load_scene(read_scene(folder_ / "scene.json")));
  }
  static void TearDownTestSuite() {
    delete scene_;
    scene_ = nullptr;
    std::filesystem::remove_all(folder_);
  }

  static inline std::filesystem::path folder_;
  static inline LoadedScene* scene_ = nullptr;
};

TEST_F(SkinPinsTest, AtRestTheyAreWhereTheyWereBound) {
  const cloth::Garment& garment = scene_->garments[0];
  const SkinPins& pins = scene_->skin_pins[0];
  ASSERT_EQ(pins.bindings.size(), 24u);
  EXPECT_LE(pins.mesh.positions.size(), 3u * 24u) << "only what is used";
  EXPECT_LT(pins.skin.slot_joint.size(), scene_->character.skin.slot_joint.size());
  std::vector<Vec3> targets(garment.pins.size(), Vec3::Constant(1e3));
  SkinPinScratch scratch;
  place_on_skin(pins, rig::rest_model(scene_->character.skeleton), scratch, targets);
  for (const SkinPins::Binding& binding : pins.bindings) {
    EXPECT_LT((targets[binding.pin] - garment.rest_positions[garment.pins[binding.pin].particle]).norm(), 1e-6);
    EXPECT_GE(binding.weights.minCoeff(), 0.0);
    EXPECT_NEAR(binding.weights.sum(), 1.0, 1e-12);
    EXPECT_LT(binding.offset.norm(), 0.05) << "a waist is near the skin";
  }
}

TEST_F(SkinPinsTest, TheyAreBoundToTheNearestTriangle) {
  const cloth::Garment& garment = scene_->garments[0];
  const rig::Mesh& mesh = scene_->character.mesh;
  std::vector<Vec3> rest(mesh.positions.size()), normals(rest.size());
  rig::skin_vertices_reference(mesh, scene_->character.skin, rig::rest_model(scene_->character.skeleton), rest,
                               normals);
  for (const SkinPins::Binding& binding : scene_->skin_pins[0].bindings) {
    const Vec3& p = garment.rest_positions[garment.pins[binding.pin].particle];
    constexpr int k_grid = 12; // points a side of each triangle: none may be nearer than the bound one
    for (const rig::Triangle& t : mesh.triangles) {
      if ((rest[t[0]] - p).norm() > 0.1) continue;
      for (int i = 0; i <= k_grid; ++i)
        for (int j = 0; i + j <= k_grid; ++j) {
          const Vec3 q = (i * rest[t[0]] + j * rest[t[1]] + (k_grid - i - j) * rest[t[2]]) / k_grid;
          ASSERT_GE((q - p).norm(), binding.offset.norm() - 1e-12);
        }
    }
  }
}

TEST_F(SkinPinsTest, TheyFollowTheWholeSkinOfEveryPose) {
  Session session(*scene_);
  session.start({scene_->garments[0].rest_positions});
  const SkinPins& pins = scene_->skin_pins[0];
  const rig::Mesh& mesh = scene_->character.mesh;
  std::vector<Vec3> skinned(mesh.positions.size()), normals(skinned.size());
  double farthest = 0.0;
  const std::vector<Vec3> first = session.garment(0).particles().positions;
  for (int frame = 0; frame < 90; ++frame) {
    session.advance();
    ASSERT_FALSE(session.failure().has_value()) << session.failure()->message();
    if (frame % 15 != 0) continue;
    rig::skin_vertices_reference(mesh, scene_->character.skin, session.world_from_joint(), skinned, normals);
    for (const SkinPins::Binding& binding : pins.bindings) {
      const rig::Triangle& t = mesh.triangles[binding.triangle];
      const Vec3 expected = target_of(binding, skinned[t[0]], skinned[t[1]], skinned[t[2]]);
      const int particle = scene_->garments[0].pins[binding.pin].particle;
      EXPECT_LT((session.garment(0).particles().positions[particle] - expected).norm(), 1e-6);
      farthest = std::max(farthest, (expected - first[particle]).norm());
    }
  }
  EXPECT_GT(farthest, 0.02) << "she moved";
}

TEST_F(SkinPinsTest, AJumpCarriesTheGarmentWithTheMainJoint) {
  Session session(*scene_);
  session.start({scene_->garments[0].rest_positions});
  const int joint = scene_->attachment_joints[0][0];
  const std::string_view name = rig::bare_joint_name(scene_->character.skeleton.names[joint]);
  EXPECT_TRUE(name == "Spine" || name == "Hips" || name == "Spine1") << name;
  const Transform before = session.world_from_joint()[joint];
  session.jump(3.0);
  const Transform carry = session.world_from_joint()[joint] * before.inverse();
  const Vec3 last = scene_->garments[0].rest_positions.back();
  EXPECT_LT((session.garment(0).particles().positions.back() - carry * last).norm(), 1e-9);
}

} // namespace
