// The importer against a plain twin: the file's own matrices, every scale kept, evaluated as the format's definition
// says.
#include "rig/character.h"
#include "rig/import/import.h"
#include "tests/rig/import/tiny_collada.h"

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <map>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;

namespace {

Matrix4 matrix_of(const aiMatrix4x4& m) {
  Matrix4 result;
  for (unsigned r = 0; r < 4; ++r)
    for (unsigned c = 0; c < 4; ++c) result(r, c) = static_cast<double>(m[r][c]);
  return result;
}

/// The keys around a tick, as assimp has them, with straight lines between.
template <typename Key, typename Blend> auto blended_at(const Key* keys, unsigned count, double tick, Blend blend) {
  const Key* after = std::find_if(keys, keys + count, [&](const Key& key) { return key.mTime >= tick; });
  if (after == keys) return keys[0].mValue;
  if (after == keys + count) return keys[count - 1].mValue;
  const Key* before = after - 1;
  return blend(before->mValue, after->mValue, (tick - before->mTime) / (after->mTime - before->mTime));
}

/// parent_from_node of an animated node.
Matrix4 local_at(const aiNodeAnim& channel, double tick) {
  const auto lerp = [](const aiVector3D& a, const aiVector3D& b, double s) {
    return a + (b - a) * static_cast<ai_real>(s);
  };
  const auto slerp = [](const aiQuaternion& a, const aiQuaternion& b, double s) {
    aiQuaternion between;
    aiQuaternion::Interpolate(between, a, b, static_cast<ai_real>(s));
    return between;
  };
  aiQuaternion q = blended_at(channel.mRotationKeys, channel.mNumRotationKeys, tick, slerp);
  q.Normalize(); // a file may give three digits
  return matrix_of(aiMatrix4x4(blended_at(channel.mScalingKeys, channel.mNumScalingKeys, tick, lerp), q,
                               blended_at(channel.mPositionKeys, channel.mNumPositionKeys, tick, lerp)));
}

void globals_of(const aiNode& node, const Matrix4& parent, const std::map<std::string, Matrix4>& moved_locals,
                std::map<std::string, Matrix4>& globals) {
  const auto found = moved_locals.find(node.mName.C_Str());
  const Matrix4 global = parent * (found == moved_locals.end() ? matrix_of(node.mTransformation) : found->second);
  globals[node.mName.C_Str()] = global;
  for (unsigned i = 0; i < node.mNumChildren; ++i) globals_of(*node.mChildren[i], global, moved_locals, globals);
}

std::vector<Vec3> skinned_by_twin(const aiScene& scene, const std::map<std::string, Matrix4>& globals, double scale) {
  std::vector<Vec3> all;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    std::vector<Eigen::Vector4d> sum(mesh.mNumVertices, Eigen::Vector4d::Zero());
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const Matrix4 skin = globals.at(mesh.mBones[b]->mName.C_Str()) * matrix_of(mesh.mBones[b]->mOffsetMatrix);
      for (unsigned w = 0; w < mesh.mBones[b]->mNumWeights; ++w) {
        const aiVertexWeight& weight = mesh.mBones[b]->mWeights[w];
        const aiVector3D& p = mesh.mVertices[weight.mVertexId];
        sum[weight.mVertexId] +=
            static_cast<double>(weight.mWeight) *
            (skin * Eigen::Vector4d(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z), 1));
      }
    }
    for (const auto& s : sum)
      if (s.w() > 0.0) all.push_back(scale * s.head<3>() / s.w());
  }
  return all;
}

/// Largest distance from a point of `from` to the nearest of `to`.
double farthest(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  double largest = 0;
  for (const Vec3& p : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& q : to) nearest = std::min(nearest, (p - q).squaredNorm());
    largest = std::max(largest, nearest);
  }
  return std::sqrt(largest);
}

void compare(const std::string& model) {
  const Import import = import_character(assimp_model(model), {.max_influences = 8, .rest = RestPose::node});
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  const aiScene* scene = importer.ReadFile(assimp_model(model).string(), aiProcess_Triangulate);
  ASSERT_NE(scene, nullptr);
  ASSERT_EQ(import.report.up_axis, "Y"); // the twin turns nothing
  ASSERT_EQ(import.clips.size(), scene->mNumAnimations);
  const auto check = [&](const std::map<std::string, Matrix4>& locals, const std::vector<Transform>& local,
                         const std::string& what) {
    std::map<std::string, Matrix4> globals;
    globals_of(*scene->mRootNode, Matrix4::Identity(), locals, globals);
    std::vector<Transform> joints(local.size());
    model_from_local(import.character.skeleton, local, joints);
    const auto twin = skinned_by_twin(*scene, globals, import.report.metres_per_unit),
               own = skinned(import.character, joints);
    EXPECT_LT(farthest(own, twin), 1e-4 * std::max(1.0, import.report.height))
        << model << " " << what; // single precision in the file, at metres
  };
  check({}, import.character.skeleton.rest_local, "at rest");
  for (std::size_t a = 0; a < import.clips.size(); ++a) {
    const aiAnimation& animation = *scene->mAnimations[a];
    const ChannelClip& clip = import.clips[a];
    const std::vector<double> times = key_times(clip);
    for (const std::size_t k : {std::size_t{0}, times.size() / 3, times.size() - 1}) {
      std::map<std::string, Matrix4> locals;
      const double per_second = animation.mTicksPerSecond == 0.0 ? 25.0 : animation.mTicksPerSecond;
      for (unsigned c = 0; c < animation.mNumChannels; ++c)
        locals[animation.mChannels[c]->mNodeName.C_Str()] = local_at(*animation.mChannels[c], times[k] * per_second);
      std::vector<Transform> local = import.character.skeleton.rest_local;
      ChannelClip once = clip;
      once.extrapolation = Extrapolation::clamp;
      sample(once, times[k], local);
      check(locals, local, clip.name + " key " + std::to_string(k));
    }
  }
}

TEST(ImportTwin, AnimatedHuman) { compare("X/BCN_Epileptic.X"); }
TEST(ImportTwin, Wolf) { compare("X/Testwuson.X"); }
TEST(ImportTwin, FbxWithScaledArmature) { compare("FBX/huesitos.fbx"); }
TEST(ImportTwin, FbxWithMovedArmature) { compare("FBX/animation_with_skeleton.fbx"); }
TEST(ImportTwin, Gltf) { compare("glTF2/simple_skin/simple_skin.gltf"); }

} // namespace
