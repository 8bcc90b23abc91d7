// Animations in imported files.
#include "rig/character.h"
#include "rig/import/import.h"
#include "tests/rig/import/tiny_collada.h"

#include <gmock/gmock.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

TEST(ImportClips, AnimationsMoveTheJointsAsInTheFile) {
  // Centimetres, Z up, an armature scaled and turned by its container: every conversion at once.
  TinyFile file = upright();
  file.unit = 0.01;
  file.up = "Z_UP";
  const Matrix4 container = moved(3, -2, 1) * turned(0.4, Vec3(1, 2, 3)) * scaled(10);
  const Matrix4 hips = moved(0, 1, 10) * turned(0.2, Vec3::UnitY()), head = moved(0, 1, 5) * turned(0.3, Vec3::UnitX());
  file.nodes[0] = {"Armature", container, {{"Hips", hips, {{"Head", head}}}}};
  file.meshes[0].inverse_binds = {(container * hips).inverse(), (container * hips * head).inverse()};
  for (Vec3& p : file.meshes[0].positions) p = Vec3(100 * p.x(), 100 * p.z(), 100 * p.y());
  const std::vector<double> times = {0, 0.5, 2};
  std::vector<Matrix4> hips_keys, head_keys;
  for (std::size_t k = 0; k < 3; ++k) {
    hips_keys.push_back(moved(0.5 * static_cast<double>(k), 1, 10) *
                        turned(0.7 * static_cast<double>(k), Vec3(0, 1, 1)));
    head_keys.push_back(moved(0, 1, 5) * turned(0.3 + static_cast<double>(k), Vec3(1, 0, 0.5)));
  }
  file.tracks = {{"Hips-1", times, hips_keys}, {"Head-2", times, head_keys}};
  const Import import = import_tiny(file);
  ASSERT_EQ(import.clips.size(), 1u);
  const ChannelClip& clip = import.clips[0];
  EXPECT_EQ(key_times(clip).size(), 3u);
  EXPECT_EQ(clip.joints.size(), 2u);
  const Matrix4 model_from_file = turned(-std::numbers::pi / 2, Vec3::UnitX()) * scaled(0.01);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(key_times(clip)[k], times[k], 1e-6);
    std::vector<Transform> local = import.character.skeleton.rest_local, model(local.size());
    sample(clip, times[k], local);
    model_from_local(import.character.skeleton, local, model);
    const auto found = skinned(import.character, model);
    const Matrix4 globals[] = {container * hips_keys[k], container * hips_keys[k] * head_keys[k]};
    for (std::size_t v = 0; v < found.size(); ++v) {
      Eigen::Vector4d sum = Eigen::Vector4d::Zero();
      for (const auto& [joint, weight] : file.meshes[0].weights[v])
        sum +=
            weight * (globals[joint] * file.meshes[0].inverse_binds[joint] * file.meshes[0].positions[v].homogeneous());
      EXPECT_LT((found[v] - (model_from_file * sum).head<3>()).norm(), 1e-5) << "key " << k << " vertex " << v;
    }
  }
}

TEST(ImportClips, AContainerThatMovesIsAJoint) {
  TinyFile file = upright();
  file.tracks = {{"Armature", {0, 1}, {moved(0, 0, 0), moved(1, 0, 0)}}};
  const Import import = import_tiny(file);
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("Armature", "Hips", "Head", "HeadTop_End"));
  ASSERT_EQ(import.clips.size(), 1u);
  EXPECT_LT((import.clips[0].joints[0].translation.values.back() - Vec3(1, 0, 0)).norm(), 2e-6);
  file.tracks = {{"Armature", {0, 1}, {moved(0, 0, 0), moved(0, 0, 0)}}}; // keys, but no motion
  EXPECT_THAT(import_tiny(file).character.skeleton.names, ElementsAre("Hips", "Head", "HeadTop_End"));
}

TEST(ImportClips, AnimatedScaleIsIgnoredAndTold) {
  TinyFile file = upright();
  const Matrix4 hips = file.nodes[0].children[0].matrix;
  file.tracks = {{"Hips-1", {0, 1}, {hips, hips * scaled(2)}}};
  const Import import = import_tiny(file);
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("changing scale of 1 joint ignored: Hips")));
}

} // namespace
