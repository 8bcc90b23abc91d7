// Debian's animated models: at their keys what the reader of meshes makes of them, in between what the file says.
#include "rig/import/fbx/fbx.h"
#include "rig/io/file_io.h"
#include "tests/support/paths.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <cctype>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::rig::import_detail;
using namespace tutu::test;

namespace {

void collect(const aiNode& from, int parent, std::vector<FileNode>& nodes) {
  FileNode node{.name = from.mName.C_Str(), .parent = parent};
  for (unsigned r = 0; r < 3; ++r)
    for (unsigned c = 0; c < 4; ++c)
      node.local(static_cast<int>(r), static_cast<int>(c)) = static_cast<double>(from.mTransformation[r][c]);
  const int index = static_cast<int>(nodes.size());
  nodes.push_back(node);
  for (unsigned i = 0; i < from.mNumChildren; ++i) collect(*from.mChildren[i], index, nodes);
}

const NodeMotion* motion_of(const FileAnimation& take, const std::vector<FileNode>& nodes, const std::string& name) {
  for (const NodeMotion& motion : take.nodes)
    if (nodes[static_cast<std::size_t>(motion.node)].name == name) return &motion;
  return nullptr;
}
Vec3 vector_of(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

class AnimatedFbxModels : public ::testing::TestWithParam<const char*> {};

TEST_P(AnimatedFbxModels, AgreeAtTheirKeysWithTheReaderOfMeshes) {
  const auto file = assimp_model(GetParam());
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  std::vector<FileNode> nodes;
  collect(*scene->mRootNode, -1, nodes);
  const FbxMotion motion = fbx_motion(read_file(file), nodes);
  ASSERT_EQ(motion.unread, "");
  ASSERT_EQ(motion.animations.size(), scene->mNumAnimations);
  EXPECT_EQ(motion.locals.size(), nodes.size() - 1);
  for (const auto& [node, local] : motion.locals) {
    const Affine& expected = nodes[static_cast<std::size_t>(node)].local;
    EXPECT_LT((local.matrix() - expected.matrix()).cwiseAbs().maxCoeff(),
              1e-6 * expected.matrix().cwiseAbs().maxCoeff());
  }
  int compared = 0;
  for (unsigned a = 0; a < scene->mNumAnimations; ++a) {
    const aiAnimation& expected = *scene->mAnimations[a];
    const FileAnimation& take = motion.animations[a];
    EXPECT_EQ(take.name, expected.mName.C_Str());
    EXPECT_NEAR(take.end - take.start, expected.mDuration / expected.mTicksPerSecond, 1e-6);
    EXPECT_TRUE(take.notes.empty());
    for (unsigned c = 0; c < expected.mNumChannels; ++c) {
      const aiNodeAnim& channel = *expected.mChannels[c];
      const NodeMotion* moved = motion_of(take, nodes, channel.mNodeName.C_Str());
      if (!moved) continue; // it stays as it stands
      for (unsigned k = 0; k < channel.mNumRotationKeys && !moved->rotation.empty(); ++k) {
        const aiQuatKey& key = channel.mRotationKeys[k];
        const Quat rotation(static_cast<double>(key.mValue.w), static_cast<double>(key.mValue.x),
                            static_cast<double>(key.mValue.y), static_cast<double>(key.mValue.z));
        const Quat found = value_at(moved->rotation, key.mTime / expected.mTicksPerSecond);
        EXPECT_LT(found.angularDistance(rotation.normalized()), 1e-6) << channel.mNodeName.C_Str();
        ++compared;
      }
      for (unsigned k = 0; k < channel.mNumPositionKeys && !moved->translation.empty(); ++k) {
        const Vec3 key = vector_of(channel.mPositionKeys[k].mValue);
        const Vec3 found = value_at(moved->translation, channel.mPositionKeys[k].mTime / expected.mTicksPerSecond);
        EXPECT_LT((found - key).norm(), 1e-6 * std::max(1.0, key.norm())) << channel.mNodeName.C_Str();
      }
    }
  }
  EXPECT_GT(compared, 5);
}

TEST(FbxModels, AllOfThemAreUnderstood) {
  int seen = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(assimp_model("FBX"))) {
    std::string extension = entry.path().extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension != ".fbx" || entry.path().stem() == "transparentTest") continue; // which is damaged
    ++seen;
    EXPECT_EQ(fbx_motion(read_file(entry.path()), {{.name = "RootNode"}}).unread, "") << entry.path();
  }
  EXPECT_GT(seen, 15);
}

INSTANTIATE_TEST_SUITE_P(Debian, AnimatedFbxModels,
                         ::testing::Values("FBX/huesitos.fbx", "FBX/animation_with_skeleton.fbx"),
                         [](const auto& model) { return std::string(model.index == 0 ? "huesitos" : "skeleton"); });

} // namespace
