#include "rig/detail/skin_kernel.h"
#include "rig/skin.h"
#include "tests/rig/random_skeleton.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;

namespace {

/// Every target that was compiled and that this processor runs.
std::vector<std::int64_t> targets() {
  std::vector<std::int64_t> all;
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  for (int bit = 0; bit < 63; ++bit)
    if ((supported >> bit) & 1) all.push_back(std::int64_t{1} << bit);
  return all;
}

/// Runs the kernel on one target for as long as this lives.
struct OnTarget {
  explicit OnTarget(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~OnTarget() { hwy::SetSupportedTargetsForTest(0); }
};

struct Body {
  Skeleton skeleton;
  Mesh mesh;
  Skin skin;
  std::vector<Transform> model;
  std::vector<SkinMatrix> palette;
};

/// A body of 1.7 m: vertices within some centimetres of the joints that carry them, in a random pose.
Body random_body(std::uint64_t seed, int joints, int vertices, int influences) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Body body;
  for (int j = 0; j < joints; ++j) {
    body.skeleton.names.push_back("J" + std::to_string(j));
    body.skeleton.parents.push_back(j - 1);
    body.skeleton.rest_local.push_back({test::random_rotation(random), test::random_vector(random, 0.05)});
  }
  body.skeleton.rest_local[0].translation.y() += 1.2;
  const std::vector<Transform> rest = rest_model(body.skeleton);
  body.skin.influences = influences;
  for (int j = 0; j < joints; ++j) {
    const Transform back = rest[j].inverse();
    body.skin.slot_joint.push_back(j);
    body.skin.inverse_bind.push_back(Eigen::Translation3d(back.translation) * back.rotation);
  }
  for (int v = 0; v < vertices; ++v) {
    const int joint = std::uniform_int_distribution<int>(0, joints - 1)(random);
    body.mesh.positions.push_back((rest[joint] * test::random_vector(random, 0.05)).cast<float>());
    body.mesh.normals.push_back(test::random_vector(random).normalized().cast<float>());
    std::vector<float> weights(influences);
    const int used = std::uniform_int_distribution<int>(1, influences)(random);
    float sum = 0.0f;
    for (int k = 0; k < used; ++k) sum += weights[k] = uniform(random) + 1e-3f;
    std::sort(weights.rbegin(), weights.rend());
    for (int k = 0; k < influences; ++k) {
      const int slot = k < used ? std::clamp(joint + (k + 1) / 2 * (k % 2 ? 1 : -1), 0, joints - 1) : 0;
      body.skin.slots.push_back(static_cast<std::uint16_t>(slot));
      body.skin.weights.push_back(weights[k] / sum);
    }
  }
  std::vector<Transform> local = body.skeleton.rest_local;
  for (Transform& joint : local)
    joint.rotation = joint.rotation * nlerp(Quat::Identity(), test::random_rotation(random), 0.3);
  body.model.resize(joints);
  model_from_local(body.skeleton, local, body.model);
  body.palette.resize(joints);
  skinning_palette(body.skin, body.model, body.palette);
  return body;
}

/// Two joints along +Y, the upper one at height 1 and bent by 90 degrees about Z; one vertex at height 1, half on
/// either.
Body elbow() {
  Body body;
  body.skin.slot_joint = {0, 1};
  body.skin.inverse_bind = {Eigen::Affine3d::Identity(), Eigen::Affine3d(Eigen::Translation3d(0, -1, 0))};
  body.model = {{Quat::Identity(), Vec3::Zero()},
                {Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ())), {0, 1, 0}}};
  const auto add = [&](Vec3f position, Vec3f normal, float upper) {
    body.mesh.positions.push_back(position);
    body.mesh.normals.push_back(normal);
    body.skin.slots.insert(body.skin.slots.end(), {1, 0, 0, 0});
    body.skin.weights.insert(body.skin.weights.end(), {upper, 1.0f - upper, 0.0f, 0.0f});
  };
  add({0.2f, 1, 0}, {1, 0, 0}, 0.5f);
  add({0.2f, 2, 0}, {1, 0, 0}, 1.0f);
  add({0.2f, 0.5f, 0}, {0, 0, 1}, 0.0f);
  body.palette.resize(2);
  skinning_palette(body.skin, body.model, body.palette);
  return body;
}

TEST(Skin, ABentElbowByHand) {
  // Lower joint: (0.2, 1, 0) stays. Upper: (0.2, 0, 0) from the elbow turns to (0, 0.2, 0). Half of each: (0.1, 1.1,
  // 0). The normals +X and +Y blend to (1, 1, 0) / sqrt 2.
  const Body body = elbow();
  const double half = std::numbers::sqrt2 / 2;
  const Vec3 positions[] = {{0.1, 1.1, 0}, {-1, 1.2, 0}, {0.2, 0.5, 0}},
             normals[] = {{half, half, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Vec3> p(3), n(3);
  skin_vertices_reference(body.mesh, body.skin, body.model, p, n);
  for (int v = 0; v < 3; ++v) {
    EXPECT_LT((p[v] - positions[v]).norm(), 1e-7);
    EXPECT_LT((n[v] - normals[v]).norm(), 1e-7);
  }
  for (const std::int64_t target : targets()) {
    const OnTarget on(target);
    std::vector<Vec3f> pf(3), nf(3);
    skin_vertices(body.mesh, body.skin, body.palette, pf, nf);
    for (int v = 0; v < 3; ++v) {
      EXPECT_LT((pf[v].cast<double>() - positions[v]).norm(), 3e-7) << hwy::TargetName(target);
      EXPECT_LT((nf[v].cast<double>() - normals[v]).norm(), 3e-7) << hwy::TargetName(target);
    }
  }
}

TEST(Skin, EveryTargetAgreesWithTheReferenceAndToTheBitWithEachOther) {
  for (const int influences : {4, 8}) {
    const Body body = random_body(7, 52, 4001, influences);
    std::vector<Vec3> p(4001), n(4001);
    skin_vertices_reference(body.mesh, body.skin, body.model, p, n);
    std::vector<Vec3f> first_p, first_n;
    double largest = 0.0;
    for (const Vec3& position : p) largest = std::max(largest, position.norm());
    EXPECT_NEAR(largest, 1.5, 0.3); // m: as large as a body
    for (const std::int64_t target : targets()) {
      const OnTarget on(target);
      EXPECT_STREQ(skin_kernel_target(), hwy::TargetName(target));
      std::vector<Vec3f> pf(4001), nf(4001), only(4001);
      skin_vertices(body.mesh, body.skin, body.palette, pf, nf);
      skin_vertices(body.mesh, body.skin, body.palette, only, {});
      EXPECT_EQ(pf, only);
      double worst_p = 0.0, worst_n = 0.0;
      for (int v = 0; v < 4001; ++v) {
        worst_p = std::max(worst_p, (pf[v].cast<double>() - p[v]).norm());
        worst_n = std::max(worst_n, (nf[v].cast<double>() - n[v]).norm());
        EXPECT_NEAR(nf[v].norm(), 1.0f, 3e-7f);
      }
      EXPECT_LT(worst_p, 1e-6) << hwy::TargetName(target);
      EXPECT_LT(worst_n, 1e-6) << hwy::TargetName(target);
      if (first_p.empty()) first_p = pf, first_n = nf;
      EXPECT_EQ(0, std::memcmp(pf.data(), first_p.data(), pf.size() * sizeof(Vec3f))) << hwy::TargetName(target);
      EXPECT_EQ(0, std::memcmp(nf.data(), first_n.data(), nf.size() * sizeof(Vec3f))) << hwy::TargetName(target);
    }
  }
}

TEST(Skin, ARangeWritesItsVerticesAndNoOthers) {
  const Body body = random_body(8, 20, 37, 4);
  std::vector<Vec3f> all_p(37), all_n(37);
  skin_vertices(body.mesh, body.skin, body.palette, all_p, all_n);
  const Vec3f mark(123.0f, -456.0f, 789.0f);
  for (const std::int64_t target : targets()) {
    const OnTarget on(target);
    for (int first = 0; first <= 9; ++first) {
      for (int last = first; last <= 37; ++last) {
        std::vector<Vec3f> p(37, mark), n(37, mark);
        skin_vertices(body.mesh, body.skin, body.palette, first, last, p, n);
        for (int v = 0; v < 37; ++v) {
          const bool inside = v >= first && v < last;
          ASSERT_EQ(p[v], inside ? all_p[v] : mark) << first << " " << last << " " << v;
          ASSERT_EQ(n[v], inside ? all_n[v] : mark) << first << " " << last << " " << v;
        }
      }
    }
  }
}

TEST(Skin, EveryVertexCountStaysWithinItsArrays) { // the sanitizers look on
  for (const std::int64_t target : targets()) {
    const OnTarget on(target);
    for (int vertices = 0; vertices < 20; ++vertices) {
      for (const int influences : {4, 8}) {
        const Body body = random_body(9, 3, vertices, influences);
        std::vector<Vec3f> p(vertices), n(vertices);
        skin_vertices(body.mesh, body.skin, body.palette, p, n);
        for (int v = 0; v < vertices; ++v) EXPECT_TRUE(p[v].allFinite() && n[v].allFinite());
      }
    }
  }
}

TEST(Skin, TheRestPoseGivesTheBindPose) {
  Body body = random_body(10, 30, 500, 4);
  body.model = rest_model(body.skeleton);
  skinning_palette(body.skin, body.model, body.palette);
  std::vector<Vec3f> p(500), n(500);
  skin_vertices(body.mesh, body.skin, body.palette, p, n);
  for (int v = 0; v < 500; ++v) {
    EXPECT_LT((p[v] - body.mesh.positions[v]).norm(), 1e-6f);
    EXPECT_LT((n[v] - body.mesh.normals[v]).norm(), 2e-6f);
  }
}

TEST(Skin, AUniformScaleInTheBindScalesPositionsAndLeavesNormalsUnit) {
  Body body = elbow(), scaled = elbow();
  for (Eigen::Affine3d& bind : scaled.skin.inverse_bind) bind = bind * Eigen::Scaling(0.01);
  for (Vec3f& position : scaled.mesh.positions) position *= 100.0f;
  skinning_palette(scaled.skin, scaled.model, scaled.palette);
  std::vector<Vec3f> p(3), n(3), ps(3), ns(3);
  skin_vertices(body.mesh, body.skin, body.palette, p, n);
  skin_vertices(scaled.mesh, scaled.skin, scaled.palette, ps, ns);
  for (int v = 0; v < 3; ++v) {
    EXPECT_LT((p[v] - ps[v]).norm(), 1e-6f);
    EXPECT_LT((n[v] - ns[v]).norm(), 1e-6f);
  }
}

TEST(Skin, NormalsThatBlendToNothingPointUp) {
  // Half of one joint at rest, half of one turned half round about X: +Y and -Y cancel. The other vertices are as ever.
  Body body = elbow();
  body.skin.inverse_bind[1].setIdentity();
  body.model[1] = {Quat(0, 1, 0, 0), Vec3::Zero()};
  skinning_palette(body.skin, body.model, body.palette);
  for (int zero = 0; zero < 6; ++zero) {
    Mesh mesh;
    Skin skin = body.skin;
    skin.slots.clear();
    skin.weights.clear();
    for (int v = 0; v < 6; ++v) {
      mesh.positions.emplace_back(1.0f, 1.0f, 1.0f);
      mesh.normals.push_back(v == zero ? Vec3f(0, 1, 0) : Vec3f(1, 0, 0));
      skin.slots.insert(skin.slots.end(), {0, 1, 0, 0});
      skin.weights.insert(skin.weights.end(), {0.5f, 0.5f, 0.0f, 0.0f});
    }
    std::vector<Vec3> pd(6), nd(6);
    skin_vertices_reference(mesh, skin, body.model, pd, nd);
    for (const std::int64_t target : targets()) {
      const OnTarget on(target);
      std::vector<Vec3f> p(6), n(6);
      skin_vertices(mesh, skin, body.palette, p, n);
      for (int v = 0; v < 6; ++v) {
        EXPECT_EQ(n[v], v == zero ? Vec3f(0, 1, 0) : Vec3f(1, 0, 0)) << hwy::TargetName(target);
        EXPECT_EQ(nd[v], n[v].cast<double>());
      }
    }
  }
}

} // namespace
