// The importer on small files whose right answer is known.
#include "rig/character.h"
#include "rig/error.h"
#include "rig/import/import.h"
#include "tests/rig/import/tiny_collada.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

constexpr double k_quarter = std::numbers::pi / 2;
constexpr double k_float = 2e-6; // m: what single precision leaves of a position of 2 m

std::vector<Vec3> at_rest(const Character& character) { return skinned(character, rest_model(character.skeleton)); }

/// The file's positions are those of the skinned rest pose, after `model_from_file`; order kept.
void expect_rest(const Import& import, const std::vector<Vec3>& positions, const Matrix4& model_from_file,
                 double tolerance = k_float) {
  const std::vector<Vec3> found = at_rest(import.character);
  ASSERT_EQ(found.size(), positions.size());
  for (std::size_t v = 0; v < found.size(); ++v)
    EXPECT_LT((found[v] - (model_from_file * positions[v].homogeneous()).head<3>()).norm(), tolerance)
        << "vertex " << v;
}

TEST(Import, OneMeshOnOneSkeleton) {
  const TinyFile file = upright();
  const Import import = import_tiny(file);
  const Character& c = import.character;
  EXPECT_THAT(c.skeleton.names, ElementsAre("Hips", "Head", "HeadTop_End"));
  EXPECT_THAT(c.skeleton.parents, ElementsAre(k_no_parent, 0, 1));
  EXPECT_LT((c.skeleton.rest_local[1].translation - Vec3(0, 0.5, 0)).norm(), k_float);
  EXPECT_NEAR(c.skeleton.rest_local[1].rotation.angularDistance(Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()))), 0,
              k_float);
  EXPECT_EQ(c.skin.slot_count(), 2);
  const auto rest = rest_model(c.skeleton);
  for (int s = 0; s < c.skin.slot_count();
       ++s) { // bound at rest: the inverse binds are those of the rest pose, exactly
    const Transform back = rest[c.skin.slot_joint[s]].inverse();
    EXPECT_LT((c.skin.inverse_bind[s].linear() - back.rotation.toRotationMatrix()).norm(), 1e-12);
    EXPECT_LT((c.skin.inverse_bind[s].translation() - back.translation).norm(), 1e-12);
  }
  expect_rest(import, file.meshes[0].positions, Matrix4::Identity());
  EXPECT_NEAR(import.report.height, 1.7, k_float);
  EXPECT_EQ(import.report.joints_without_weight, 1);
  EXPECT_EQ(import.report.largest_influences, 2);
  EXPECT_EQ(import.report.up_axis, "Y");
  EXPECT_EQ(import.report.file_skeletons, 1);
  EXPECT_THAT(import.report.notes, IsEmpty());
  EXPECT_TRUE(import.clips.empty());
  ASSERT_EQ(c.mesh.parts.size(), 1u);
  EXPECT_EQ(c.mesh.parts[0].triangle_count, 2u);
  for (const Vec3f& n : c.mesh.normals) EXPECT_GT(n.z(), 0.9f); // the strip looks along +Z
}

TEST(Import, UnitsAndAxesOfCollada) {
  for (const double unit : {1.0, 0.01, 0.0254}) {
    for (const bool z_up : {false, true}) {
      TinyFile file = upright();
      file.unit = unit;
      file.up = z_up ? "Z_UP" : "Y_UP";
      const Matrix4 file_from_model = (z_up ? turned(k_quarter, Vec3::UnitX()) : scaled(1)) * scaled(1 / unit);
      const Matrix4 model_from_file = file_from_model.inverse();
      // The same body in the file's unit and axes: nodes and binds are conjugated.
      const auto convert = [&](const Matrix4& m) { return Matrix4(file_from_model * m * model_from_file); };
      std::vector<TinyNode*> open = {&file.nodes[0], &file.nodes[1]};
      while (!open.empty()) {
        TinyNode* node = open.back();
        open.pop_back();
        node->matrix = convert(node->matrix);
        for (TinyNode& child : node->children) open.push_back(&child);
      }
      for (Matrix4& m : file.meshes[0].inverse_binds) m = convert(m);
      for (Vec3& p : file.meshes[0].positions) p = (file_from_model * p.homogeneous()).head<3>();
      const Import import = import_tiny(file);
      expect_rest(import, file.meshes[0].positions, model_from_file, 1e-5);
      EXPECT_NEAR(import.report.height, 1.7, 1e-5);
      EXPECT_NEAR(import.report.metres_per_unit, unit, 1e-7 * unit);
      EXPECT_EQ(import.report.up_axis, z_up ? "Z" : "Y");
      EXPECT_LT((rest_model(import.character.skeleton)[1].translation - Vec3(0, 1.5, 0)).norm(), 1e-5);
      for (const Vec3f& n : import.character.mesh.normals) EXPECT_GT(n.z(), 0.9f);
    }
  }
}

/// As upright(), in centimetres, though the file says metres.
TinyFile in_centimetres() {
  TinyFile file = upright();
  file.nodes[0].children[0].matrix = moved(0, 100, 0);
  file.nodes[0].children[0].children[0].matrix = moved(0, 50, 0);
  file.meshes[0].inverse_binds = {moved(0, -100, 0), moved(0, -150, 0)};
  for (Vec3& p : file.meshes[0].positions) p *= 100;
  return file;
}

TEST(Import, WhatAFileSaysOfItsUnitCounts) {
  const TinyFile file = in_centimetres();
  const Import import = import_tiny(file);
  EXPECT_NEAR(import.report.height, 170.0, 1e-3);
  EXPECT_DOUBLE_EQ(import.report.metres_per_unit, 1.0);
  EXPECT_THAT(import.report.notes, ElementsAre(AllOf(HasSubstr("170 m high, as its unit says"),
                                                     HasSubstr("0.01 times that, 1.7 m"), HasSubstr("--height"))));
  expect_rest(import, file.meshes[0].positions, Matrix4::Identity(), 1e-3);
}

TEST(Import, WhoAsksDecidesOfTheSize) {
  const TinyFile file = in_centimetres();
  for (const ImportOptions& options : {ImportOptions{.height = 1.7}, ImportOptions{.metres_per_unit = 0.01}}) {
    const Import import = import_tiny(file, options);
    EXPECT_NEAR(import.report.height, 1.7, 1e-5);
    EXPECT_NEAR(import.report.metres_per_unit, 0.01, 1e-7);
    EXPECT_THAT(import.report.notes, IsEmpty());
    expect_rest(import, file.meshes[0].positions, scaled(0.01), 1e-5);
  }
  EXPECT_NEAR(import_tiny(file, {.height = 5.2}).report.height, 5.2, 1e-5);
  EXPECT_THAT(import_tiny(file, {.height = 5.2}).report.notes, IsEmpty()) << "it was said";
}

TEST(Import, ABodyOfMillimetresIsRefusedWithTheLikelyFactor) {
  TinyFile file = in_centimetres();
  file.unit = 1e-4;
  try {
    import_tiny(file);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("0.017 m"), HasSubstr("100 times"), HasSubstr("--height")));
  }
  EXPECT_NEAR(import_tiny(file, {.height = 1.7}).report.height, 1.7, 1e-5);
}

TEST(Import, UnitsByNameAndByNumber) {
  EXPECT_EQ(metres_in("cm"), 0.01);
  EXPECT_EQ(metres_in("inches"), 0.0254);
  EXPECT_EQ(metres_in("0.5"), 0.5);
  for (const char* wrong : {"", "cms", "0", "-1", "nan", "inf", "1e12", "1 m"}) EXPECT_FALSE(metres_in(wrong)) << wrong;
}

TEST(Import, ScaledArmature) {
  // As exporters write it: metres outside, an armature of scale 0.01 with joints in centimetres inside.
  TinyFile file = upright();
  const Matrix4 hips = moved(0, 100, 0), head = moved(0, 50, 0) * turned(0.3, Vec3::UnitX());
  file.nodes[0] = {"Armature", scaled(0.01), {{"Hips", hips, {{"Head", head}}}}};
  file.meshes[0].inverse_binds = {(scaled(0.01) * hips).inverse(), (scaled(0.01) * hips * head).inverse()};
  const Import import = import_tiny(file);
  EXPECT_LT((rest_model(import.character.skeleton)[1].translation - Vec3(0, 1.5, 0)).norm(), 1e-5);
  expect_rest(import, file.meshes[0].positions, Matrix4::Identity(), 1e-5);
  const auto rest = rest_model(import.character.skeleton);
  for (int s = 0; s < 2; ++s)
    EXPECT_LT((import.character.skin.inverse_bind[s].translation() -
               rest[import.character.skin.slot_joint[s]].inverse().translation)
                  .norm(),
              1e-12);
}

TEST(Import, MeshNodeTransformsDoNotMoveASkin) {
  TinyFile file = upright();
  file.nodes[1].matrix = moved(5, 6, 7) * turned(1, Vec3::UnitY()) * scaled(3);
  expect_rest(import_tiny(file), file.meshes[0].positions, Matrix4::Identity());
}

TEST(Import, BindShapeCounts) {
  TinyFile file = upright();
  file.meshes[0].bind_shape = turned(0.2, Vec3::UnitZ()) * scaled(1.1);
  expect_rest(import_tiny(file), file.meshes[0].positions, file.meshes[0].bind_shape);
}

TEST(Import, BindPoseAwayFromRestPose) {
  TinyFile file = upright();
  file.nodes[0].children[0].children[0].matrix =
      moved(0.1, 0.4, 0) * turned(1.0, Vec3::UnitZ()); // the head rests elsewhere
  const Import import = import_tiny(file);
  const Matrix4 hips = file.nodes[0].children[0].matrix, head = hips * file.nodes[0].children[0].children[0].matrix;
  std::vector<Vec3> expected;
  for (std::size_t v = 0; v < 4; ++v) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (const auto& [joint, weight] : file.meshes[0].weights[v])
      sum += weight * ((joint == 0 ? hips : head) * file.meshes[0].inverse_binds[joint] *
                       file.meshes[0].positions[v].homogeneous());
    expected.push_back(sum.head<3>());
  }
  expect_rest(import, expected, Matrix4::Identity());
}

TEST(Import, RestsInItsBindPose) {
  // Authored in a leap: away from where it was bound, the head bent.
  TinyFile file = upright();
  Matrix4& hips = file.nodes[0].children[0].matrix;
  Matrix4& head = file.nodes[0].children[0].children[0].matrix;
  const Matrix4 bound_hips = hips, bound_head = hips * head;
  hips = moved(0.3, 1.4, 0.2) * turned(0.8, Vec3(1, 0.2, 0));
  head = head * turned(1.0, Vec3::UnitZ());
  const Import import = import_tiny(file);
  const auto rest = rest_model(import.character.skeleton);
  EXPECT_LT((rest[0].translation - bound_hips.topRightCorner<3, 1>()).norm(), 1e-6);
  EXPECT_LT((rest[1].translation - bound_head.topRightCorner<3, 1>()).norm(), 1e-6);
  EXPECT_LT((rest[2].translation - (bound_head * moved(0, 0.2, 0)).topRightCorner<3, 1>()).norm(), 1e-6)
      << "an unbound joint goes with its parent";
  EXPECT_NEAR(import.report.height, 1.7, 1e-5);
  expect_rest(import, file.meshes[0].positions, Matrix4::Identity());
  EXPECT_THAT(import.report.notes, ElementsAre(HasSubstr("rests in its bind pose")));

  const Import by_nodes = import_tiny(file, {.rest = RestPose::node});
  EXPECT_LT((rest_model(by_nodes.character.skeleton)[0].translation - Vec3(0.3, 1.4, 0.2)).norm(), 1e-6);
  EXPECT_THAT(by_nodes.report.notes, IsEmpty());
  for (std::size_t v = 0; v < 2; ++v) // bound to the hips alone
    EXPECT_LT((skinned(by_nodes.character, rest_model(by_nodes.character.skeleton))[v] -
               (hips * bound_hips.inverse() * file.meshes[0].positions[v].homogeneous()).head<3>())
                  .norm(),
              1e-5);
}

TEST(Import, AMotionLeavesOthersWhereTheirNodesStand) {
  TinyFile file = upright();
  const Matrix4 bound = file.nodes[0].children[0].matrix;
  Matrix4& head = file.nodes[0].children[0].children[0].matrix;
  head = head * turned(1.0, Vec3::UnitZ());
  file.tracks = {{"Hips-1", {0, 1}, {bound, moved(1, 0, 0) * bound}}};
  const Import import = import_tiny(file);
  std::vector<Transform> local(import.character.skeleton.rest_local);
  sample(import.clips.at(0), 0.0, local);
  EXPECT_LT(local[1].rotation.angularDistance(Quat(Eigen::Matrix3d(head.topLeftCorner<3, 3>()))), 1e-6);
  EXPECT_GT(local[1].rotation.angularDistance(import.character.skeleton.rest_local[1].rotation), 0.9);
}

/// A second mesh, and a second skeleton with the names of the first, `apart` from it in x.
TinyFile two_of_each(double apart) {
  TinyFile file = upright();
  TinyNode second = file.nodes[0];
  second.name = "Armature2";
  second.matrix = moved(apart, 0, 0);
  TinyMesh spheres = file.meshes[0];
  spheres.id = "spheres";
  for (Vec3& p : spheres.positions) p.x() += apart;
  for (Matrix4& m : spheres.inverse_binds) m = m * moved(-apart, 0, 0);
  file.nodes.push_back(second);
  file.nodes.push_back({"Spheres", Matrix4::Identity(), {}, "spheres"});
  file.meshes.push_back(spheres);
  return file;
}

TEST(Import, TwoSkeletonsAtOnePlaceAreOne) {
  const TinyFile file = two_of_each(0);
  const Import import = import_tiny(file);
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("Hips", "Head", "HeadTop_End"));
  EXPECT_EQ(import.report.file_skeletons, 2);
  EXPECT_EQ(import.report.file_meshes, 2);
  EXPECT_EQ(import.character.skin.slot_count(), 2); // one bind, so the meshes share slots
  ASSERT_EQ(import.character.mesh.parts.size(), 2u);
  EXPECT_EQ(import.character.mesh.parts[1].first_triangle, 2u);
  EXPECT_EQ(import.character.mesh.vertex_count(), 8); // meshes are not welded to each other
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("2 skeletons put in common: 3 joints")));
}

TEST(Import, SameNamesAtDifferentPlacesAreToldApart) {
  const TinyFile file = two_of_each(0.5);
  const Import import = import_tiny(file);
  EXPECT_THAT(import.character.skeleton.names,
              ElementsAre("Hips", "Head", "HeadTop_End", "Hips_2", "Head_2", "HeadTop_End_2"));
  EXPECT_EQ(import.character.skin.slot_count(), 4);
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("Hips_2, Head_2, HeadTop_End_2")));
  std::vector<Vec3> positions = file.meshes[0].positions;
  positions.insert(positions.end(), file.meshes[1].positions.begin(), file.meshes[1].positions.end());
  expect_rest(import, positions, Matrix4::Identity());
  // The second mesh hangs on the second skeleton: moving the first does not move it.
  auto model = rest_model(import.character.skeleton);
  for (int j = 0; j < 3; ++j) model[j].translation.z() += 9;
  const auto posed = skinned(import.character, model);
  for (std::size_t v = 0; v < 8; ++v) EXPECT_NEAR(posed[v].z() - positions[v].z(), v < 4 ? 9 : 0, 1e-5);
}

TEST(Import, ARenamedJointTakesNoNameThatExists) {
  TinyFile file = two_of_each(0.5);
  file.nodes[0].children[0].children[0].children[0].name = "Hips_2";
  EXPECT_THAT(import_tiny(file).character.skeleton.names,
              ElementsAre("Hips", "Head", "Hips_2", "Hips_3", "Head_2", "HeadTop_End"));
}

TEST(Import, AnUnskinnedRootOfSeveralBonesIsAJoint) {
  TinyFile file = upright();
  file.nodes[0].children[0].children.clear();
  file.nodes[0] = {
      "World", Matrix4::Identity(), {{"Root", moved(0, 1, 0), {{"Hips", moved(0, 0, 0)}, {"Head", moved(0, 0.5, 0)}}}}};
  file.meshes[0].inverse_binds = {moved(0, -1, 0), moved(0, -1.5, 0)};
  const Import import = import_tiny(file);
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("Root", "Hips", "Head"));
  EXPECT_THAT(import.character.skeleton.parents, ElementsAre(k_no_parent, 0, 0));
  expect_rest(import, file.meshes[0].positions, Matrix4::Identity());
}

/// Hips, six joints in a row above, and one vertex that hangs on all of them.
TinyFile many_influences() {
  TinyFile file = upright();
  TinyNode chain{"J5", moved(0, 0.1, 0)};
  for (int j = 4; j >= 0; --j) chain = {"J" + std::to_string(j), moved(0, j == 0 ? 1 : 0.1, 0), {chain}};
  file.nodes[0].children = {chain};
  TinyMesh& mesh = file.meshes[0];
  mesh.joints.clear();
  mesh.inverse_binds.clear();
  for (int j = 0; j < 6; ++j) {
    mesh.joints.push_back("J" + std::to_string(j));
    mesh.inverse_binds.push_back(moved(0, -1 - 0.1 * j, 0));
  }
  mesh.weights[3] = {{0, 0.05}, {1, 0.1}, {2, 0.15}, {3, 0.2}, {4, 0.2}, {5, 0.3}};
  return file;
}

TEST(Import, SixInfluencesCutToFour) {
  const Import import = import_tiny(many_influences());
  EXPECT_EQ(import.report.largest_influences, 6);
  EXPECT_EQ(import.report.cut_vertices, 1);
  EXPECT_NEAR(import.report.largest_cut, 0.15, 1e-6);
  EXPECT_THAT(import.report.notes, Contains("1 vertex cut to 4 influences"));
  const Skin& skin = import.character.skin;
  const float expected[] = {0.3f / 0.85f, 0.2f / 0.85f, 0.2f / 0.85f, 0.15f / 0.85f};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(skin.weights[12 + k], expected[k], 1e-6f);
  EXPECT_EQ(import.character.skeleton.names[skin.slot_joint[skin.slots[12]]], "J5");
}

TEST(Import, EightInfluencesKeepSix) {
  const Import import = import_tiny(many_influences(), {.max_influences = 8});
  EXPECT_EQ(import.report.cut_vertices, 0);
  EXPECT_EQ(import.character.skin.influences, 8);
  EXPECT_NEAR(import.character.skin.weights[24 + 5], 0.05f, 1e-6f);
  EXPECT_EQ(import.character.skin.weights[24 + 6], 0.0f);
}

TEST(Import, WeightsAreNormalised) {
  TinyFile file = upright();
  for (auto& vertex : file.meshes[0].weights)
    for (auto& [joint, weight] : vertex) weight *= 0.5;
  const Import import = import_tiny(file);
  expect_rest(import, file.meshes[0].positions, Matrix4::Identity());
  for (int v = 0; v < 4; ++v) {
    float sum = 0;
    for (int k = 0; k < 4; ++k) sum += import.character.skin.weights[static_cast<std::size_t>(4 * v + k)];
    EXPECT_NEAR(sum, 1.0f, 1e-6f);
  }
}

TEST(Import, WeldsEqualWeightsOnly) {
  TinyFile file = upright();
  TinyMesh& mesh = file.meshes[0];
  mesh.triangles = {{0, 1, 2}, {5, 4, 3}}; // 4 doubles 1, 5 doubles 2
  mesh.positions.push_back(mesh.positions[1]);
  mesh.positions.push_back(mesh.positions[2]);
  mesh.weights.push_back(mesh.weights[1]);
  mesh.weights.push_back(mesh.weights[2]);
  const Import equal = import_tiny(file);
  EXPECT_EQ(equal.report.file_vertices, 6);
  EXPECT_EQ(equal.character.mesh.vertex_count(), 4);
  EXPECT_EQ(equal.character.mesh.triangles.size(), 2u);
  mesh.weights[5] = {{0, 0.5}, {1, 0.5}};
  EXPECT_EQ(import_tiny(file).character.mesh.vertex_count(), 5);
}

TEST(Import, DropsTrianglesThatWeldingMakesEmpty) {
  TinyFile file = upright();
  TinyMesh& mesh = file.meshes[0];
  mesh.positions.push_back(mesh.positions[1]);
  mesh.weights.push_back(mesh.weights[1]);
  mesh.triangles.push_back({0, 1, 4});
  const Import import = import_tiny(file);
  EXPECT_EQ(import.character.mesh.triangles.size(), 2u);
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("1 triangle without area")));
}

TEST(Import, VerticesWithoutWeightHangOnTheMeshsMainJoint) {
  TinyFile file = upright();
  file.meshes[0].weights[3].clear();
  const Import import = import_tiny(file);
  EXPECT_EQ(import.character.skeleton.names[import.character.skin.slot_joint[import.character.skin.slots[12]]], "Hips");
  EXPECT_FLOAT_EQ(import.character.skin.weights[12], 1.0f);
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("1 vertex without weights bound to Hips")));
}

TEST(Import, UnskinnedMeshesRideOnTheirJointOrAreLeftOut) {
  TinyFile file = upright();
  const TinyMesh box{.id = "crown", .positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, .triangles = {{0, 1, 2}}};
  TinyMesh floor = box;
  floor.id = "floor";
  file.meshes.push_back(box);
  file.meshes.push_back(floor);
  const Matrix4 placed = moved(0, 0.1, 0) * scaled(0.5);
  file.nodes[0].children[0].children[0].children.push_back({"Crown", placed, {}, "crown"});
  file.nodes.push_back({"Floor", Matrix4::Identity(), {}, "floor"});
  const Import import = import_tiny(file);
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("Hips", "Head", "HeadTop_End"));
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("bound rigidly to the joint above: crown (on Head)")));
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("left out: floor")));
  std::vector<Vec3> positions = file.meshes[0].positions;
  const Matrix4 head = file.nodes[0].children[0].matrix * file.nodes[0].children[0].children[0].matrix;
  for (const Vec3& p : box.positions) positions.push_back((head * placed * p.homogeneous()).head<3>());
  expect_rest(import, positions, Matrix4::Identity());
}

TEST(Import, SameFileSameBits) {
  const auto file = write_text("tiny.dae", collada_text(two_of_each(0.5)));
  const Import a = import_character(file), b = import_character(file);
  EXPECT_EQ(a.character.mesh.positions, b.character.mesh.positions);
  EXPECT_EQ(a.character.mesh.normals, b.character.mesh.normals);
  EXPECT_EQ(a.character.mesh.triangles, b.character.mesh.triangles);
  EXPECT_EQ(a.character.skin.slots, b.character.skin.slots);
  EXPECT_EQ(a.character.skin.weights, b.character.skin.weights);
  for (int s = 0; s < a.character.skin.slot_count(); ++s)
    EXPECT_EQ(a.character.skin.inverse_bind[s].matrix(), b.character.skin.inverse_bind[s].matrix());
  EXPECT_EQ(a.report.notes, b.report.notes);
}

} // namespace
