// Debian's animated models: in Collada what their own words say.
#include "tests/rig/import/collada/collada_text.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::rig::import_detail;
using namespace tutu::test;
using ::testing::IsEmpty;

namespace {

std::vector<FileAnimation> clips_of_model(const std::string& name) {
  const ColladaDocument document(assimp_model("Collada/" + name).string());
  std::map<std::string, int> node_of;
  for (const auto& [reference, shown] : display_names(document)) {
    const int node = static_cast<int>(node_of.size());
    node_of.emplace(reference, node);
  }
  return animations(document, node_of);
}

TEST(ColladaModels, ClipsOfAnArmature) {
  const auto clips = clips_of_model("library_animation_clips.dae");
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0].name, "bend");
  EXPECT_NEAR(clips[0].start, 1.0 / 24, 1e-9);
  EXPECT_NEAR(clips[0].end, 0.625, 1e-9);
  EXPECT_EQ(clips[1].name, "turn");
  EXPECT_EQ(clips[1].start, 0.0);
  EXPECT_NEAR(clips[1].end, 20.0 / 24, 1e-9);
  for (const FileAnimation& clip : clips) {
    EXPECT_EQ(clip.nodes.size(), 6u);
    EXPECT_THAT(clip.notes, IsEmpty());
  }
}

TEST(ColladaModels, AnAnimationInAnAnimation) {
  const auto clips = clips_of_model("box_nested_animation.dae");
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_EQ(clips[0].name, "Armature");
  ASSERT_EQ(clips[0].nodes.size(), 1u);
  EXPECT_EQ(clips[0].nodes[0].rotation.times.size(), 40u);
}

TEST(ColladaModels, AnglesThatTurnRoundBetweenTwoKeys) {
  // Sixty-four boxes, their turns written as angles about X, Y and Z that go far beyond half a turn between two keys.
  const auto clips = clips_of_model("anims_with_full_rotations_between_keys.DAE");
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_EQ(clips[0].nodes.size(), 64u);
  EXPECT_THAT(clips[0].notes, IsEmpty());
  const RotationCurve& turn = clips[0].nodes[0].rotation;
  EXPECT_GT(turn.times.size(), 3u);
  double way = 0.0;
  for (std::size_t k = 0; k + 1 < turn.times.size(); ++k)
    way += Quat(turn.values[k]).angularDistance(Quat(turn.values[k + 1]));
  EXPECT_GT(way, 6.28);
}

} // namespace
