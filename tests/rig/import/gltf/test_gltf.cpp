// What the reader of glTF makes of a file: nodes, what they draw, skins, animations, and what it says of them.
#include "rig/error.h"
#include "rig/import/gltf/gltf.h"
#include "tests/rig/import/gltf/gltf_body.h"
#include "tests/rig/import/gltf/scene_corners.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::test;
using namespace tutu::rig::import_detail;
using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

namespace {

FileScene read(const GltfMaker& maker) {
  return read_gltf(GltfMaker::write(scratch_folder() / "body.glb", maker.glb()));
}

std::string message_of(const GltfMaker& maker) {
  try {
    read(maker);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

const FileNode& node_named(const FileScene& scene, const std::string& name) {
  for (const FileNode& node : scene.nodes)
    if (node.name == name) return node;
  throw std::runtime_error("no node " + name);
}

double height_of(const std::vector<Vec3>& corners) {
  double highest = 0.0;
  for (const Vec3& corner : corners) highest = std::max(highest, corner.y());
  return highest;
}

TEST(Gltf, NodesAreTheFilesWithARootAboveThem) {
  for (const bool children_first : {false, true}) {
    const FileScene scene = read(GltfBody({.children_first = children_first}).maker);
    ASSERT_EQ(scene.nodes.size(), 9u);
    EXPECT_EQ(scene.nodes[0].name, "");
    EXPECT_EQ(scene.nodes[0].parent, -1);
    for (std::size_t n = 1; n < scene.nodes.size(); ++n) EXPECT_LT(scene.nodes[n].parent, static_cast<int>(n));
    const FileNode& hand = node_named(scene, "RightHand");
    EXPECT_EQ(scene.nodes[static_cast<std::size_t>(hand.parent)].name, "RightArm");
    EXPECT_EQ(Vec3(hand.local.translation()), Vec3(-0.3, 0, 0));
    EXPECT_EQ(scene.metres_per_unit, 1.0);
    EXPECT_EQ(scene.up_axis, 'Y');
    EXPECT_EQ(scene.format, "glTF 2.0 binary");
    EXPECT_THAT(scene.notes, IsEmpty());
  }
}

TEST(Gltf, ChannelsAreOfNodesNeverOfNames) {
  GltfBody body({});
  const int prop = body.maker.add("nodes", {{"name", "RightArm"}});
  body.maker.root["scenes"][0]["nodes"].push_back(prop);
  json& channels = body.maker.root["animations"][0]["channels"];
  channels.push_back({{"sampler", 0}, {"target", {{"node", prop}, {"path", "translation"}}}});
  const FileScene scene = read(body.maker);
  ASSERT_EQ(scene.animations.size(), 1u);
  std::vector<int> moved;
  for (const NodeMotion& motion : scene.animations[0].nodes) moved.push_back(motion.node);
  EXPECT_TRUE(std::is_sorted(moved.begin(), moved.end()));
  EXPECT_EQ(moved.size(), 5u);
  int by_translation = 0;
  for (const NodeMotion& motion : scene.animations[0].nodes)
    if (scene.nodes[static_cast<std::size_t>(motion.node)].name == "RightArm")
      by_translation += motion.translation.empty() ? 0 : 1;
  EXPECT_EQ(by_translation, 1);
}

TEST(Gltf, OneMeshUnderTwoNodesWithTwoSkins) {
  GltfBody body({});
  json& root = body.maker.root;
  json skin = root["skins"][0];
  const int armature = body.maker.add("nodes", {{"name", "Other"}, {"translation", {1.6, 0, 0}}});
  const auto first = static_cast<int>(root["nodes"].size());
  for (int j = 0; j < GltfBody::k_joints; ++j) { // a second skeleton, the same but for its place
    json node = root["nodes"][static_cast<std::size_t>(j)];
    for (json& child : node["children"]) child = child.get<int>() + first;
    if (node["children"].is_null()) node.erase("children");
    body.maker.add("nodes", node);
  }
  for (json& joint : skin["joints"]) joint = joint.get<int>() + first;
  const int drawn = body.maker.add("nodes", {{"name", "Body"}, {"mesh", 0}, {"skin", body.maker.add("skins", skin)}});
  root["nodes"][static_cast<std::size_t>(armature)]["children"] = {first, drawn};
  root["scenes"][0]["nodes"].push_back(armature);

  const FileScene scene = read(body.maker);
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  const std::vector<Vec3> corners = scene_corners(scene, -1, 0.0);
  const std::size_t half = corners.size() / 2;
  const Eigen::AngleAxisd turn(0.4, Vec3::UnitY()); // how the first armature stands
  for (std::size_t i = 0; i < half; ++i)
    EXPECT_LT((turn * (corners[half + i] - Vec3(1.6, 0, 0)) + Vec3(0.1, 0, 0.2) - corners[i]).norm(), 1e-6);
}

TEST(Gltf, OnlyTheDefaultSceneDraws) {
  GltfBody body({});
  json& root = body.maker.root;
  const int other = body.maker.add("nodes", {{"name", "Unlisted"}, {"mesh", 0}});
  root["scenes"].push_back({{"nodes", {other}}});
  FileScene scene = read(body.maker);
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(node_named(scene, "Unlisted").parent, 0);
  root["scene"] = 1;
  scene = read(body.maker);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.nodes[static_cast<std::size_t>(scene.instances[0].node)].name, "Unlisted");
  EXPECT_THAT(scene.instances[0].skin, IsEmpty());
  root.erase("scene"); // then the first
  EXPECT_EQ(read(body.maker).nodes[1].name, "Armature");
  root.erase("scenes"); // then all
  EXPECT_EQ(read(body.maker).instances.size(), 2u);
}

TEST(Gltf, WhatIsHiddenIsNotDrawn) {
  GltfBody body({});
  json& nodes = body.maker.root["nodes"];
  nodes[static_cast<std::size_t>(body.armature_node)]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_THAT(read(body.maker).instances, IsEmpty()); // its children neither
  nodes[static_cast<std::size_t>(body.armature_node)]["extensions"]["KHR_node_visibility"]["visible"] = true;
  EXPECT_EQ(read(body.maker).instances.size(), 1u);
}

TEST(Gltf, CamerasAndLightsAreAids) {
  GltfBody body({});
  for (json node : {json{{"name", "Eye"}, {"camera", 0}},
                    json{{"name", "Lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}})
    body.maker.root["scenes"][0]["nodes"].push_back(body.maker.add("nodes", node));
  const FileScene scene = read(body.maker);
  for (const FileNode& node : scene.nodes)
    EXPECT_EQ(node.is_aid, node.name == "Eye" || node.name == "Lamp") << node.name;
}

TEST(Gltf, VerticesThatPrimitivesShareAreTakenByWhoUsesThem) {
  GltfBody body({});
  json& primitives = body.maker.root["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]); // as exporters of VRM do: one list of vertices, an index list a material
  primitives[1]["indices"] = body.maker.add_indices({16, 18, 17, 17, 18, 19}, k_uint16);
  const FileScene scene = read(body.maker);
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].name, "body-0");
  EXPECT_EQ(scene.meshes[0].positions.size(), 48u);
  EXPECT_EQ(scene.meshes[1].positions.size(), 4u);
  EXPECT_EQ(scene.meshes[1].normals.size(), 4u);
  EXPECT_EQ(scene.meshes[1].first.size(), 5u);
  const std::vector<Vec3> corners = scene_corners(scene, 0, 1.0);
  const std::size_t all = 3 * scene.meshes[0].triangles.size();
  const std::vector<rig::Triangle>& of_first = scene.meshes[0].triangles;
  for (std::size_t t = 0; t < of_first.size(); ++t)
    if (of_first[t] == rig::Triangle{16, 18, 17}) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(corners[all + k], corners[3 * t + k]);
    }
}

TEST(Gltf, PointsAndLinesAreLoose) {
  for (const int mode : {0, 1, 2, 3}) {
    GltfBody body({.has_indices = false});
    body.maker.root["meshes"][0]["primitives"][0]["mode"] = mode;
    const FileScene scene = read(body.maker);
    EXPECT_THAT(scene.meshes[0].triangles, IsEmpty());
    const std::size_t vertices = scene.meshes[0].positions.size();
    const std::size_t loose[] = {vertices, vertices / 2, vertices, vertices - 1};
    EXPECT_EQ(scene.meshes[0].loose, loose[mode]);
  }
}

TEST(Gltf, DefaultWeightsOfMorphTargetsAreInTheShape) {
  GltfBody body({.morph = 1.0});
  FileScene scene = read(body.maker);
  EXPECT_NEAR(height_of(scene_corners(scene, -1, 0.0)), 1.95, 1e-6);
  EXPECT_THAT(scene.notes, ElementsAre("mesh body has the shape of 1 morph target in it, by their default weights"));
  body.maker.root["nodes"][static_cast<std::size_t>(body.body_node)]["weights"] = {
      0.5}; // the node's, before the mesh's
  EXPECT_NEAR(height_of(scene_corners(read(body.maker), -1, 0.0)), 1.85, 1e-6);
  body.maker.root["nodes"][static_cast<std::size_t>(body.body_node)]["weights"] = {0.0};
  scene = read(body.maker);
  EXPECT_NEAR(height_of(scene_corners(scene, -1, 0.0)), 1.75, 1e-6);
  EXPECT_THAT(scene.notes, IsEmpty());
  body.maker.root["nodes"][static_cast<std::size_t>(body.body_node)]["weights"] = {0.0, 1.0};
  EXPECT_THAT(message_of(body.maker), HasSubstr("a weight for morph target 1 of 1"));
}

TEST(Gltf, MotionOfMorphTargetsAndPointersIsNoted) {
  GltfBody body({.morph = 0.0});
  json& channels = body.maker.root["animations"][0]["channels"];
  channels.push_back({{"sampler", 0}, {"target", {{"node", body.body_node}, {"path", "weights"}}}});
  channels.push_back(
      {{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", json::object()}}}}}});
  channels.push_back({{"sampler", 0}, {"target", {{"path", "translation"}}}}); // of no node: ignored
  const FileScene scene = read(body.maker);
  EXPECT_THAT(scene.animations[0].notes, ElementsAre("it animates the weights of morph targets, which stand still here",
                                                     "it has channels of KHR_animation_pointer, which are not read"));
  EXPECT_EQ(scene.animations[0].nodes.size(), 4u);
}

TEST(Gltf, TheTimeLineIsTheFiles) {
  GltfBody body({});
  json& animation = body.maker.root["animations"][0];
  animation["samplers"].push_back({{"input", body.maker.add_accessor({1.25, 7.5}, "SCALAR")},
                                   {"output", body.maker.add_accessor({0, 1, 0, 0, 2, 0}, "VEC3")}});
  FileScene scene = read(body.maker); // a sampler that no channel uses
  EXPECT_EQ(scene.animations[0].start, 0.0);
  EXPECT_EQ(scene.animations[0].end, 2.0);
  animation["channels"] = {{{"sampler", 4}, {"target", {{"node", 0}, {"path", "translation"}}}}};
  scene = read(body.maker);
  EXPECT_EQ(scene.animations[0].end, 7.5);
  const rig::VectorCurve& curve = scene.animations[0].nodes.at(0).translation;
  EXPECT_THAT(curve.times, ElementsAre(1.25, 7.5));
  EXPECT_EQ(value_at(curve, 0.0), Vec3(0, 1, 0));
}

TEST(Gltf, KeysAtOneTimeAreAJump) {
  GltfBody body({});
  json& animation = body.maker.root["animations"][0];
  animation["samplers"][0]["input"] = body.maker.add_accessor({0, 1, 1}, "SCALAR");
  const FileScene scene = read(body.maker);
  EXPECT_THAT(scene.animations[0].notes, ElementsAre("it has keys at the time of the one before (1): jumps"));
  const rig::VectorCurve& curve = scene.animations[0].nodes.at(0).translation;
  EXPECT_NEAR(value_at(curve, 1.0 - 1e-9).x(), 0.3, 1e-6);
  EXPECT_NEAR(value_at(curve, 1.0).x(), 0.5, 1e-6);
  animation["samplers"][0]["input"] = body.maker.add_accessor({0, 1, 0.5}, "SCALAR");
  EXPECT_THAT(message_of(body.maker), HasSubstr("key 2 at 0.500000 s after one at 1.000000 s"));
}

TEST(Gltf, RotationsAreMadeUnit) {
  const auto with_length = [](double length) {
    GltfBody body({});
    json& animation = body.maker.root["animations"][0];
    animation["samplers"][1]["output"] =
        body.maker.add_accessor({0, 0, 0, 1, 0, 0, 0.6 * length, 0.8 * length, 0, 0, 0, 1, 0, 0, -0.6, 0.8}, "VEC4");
    return body.maker;
  };
  FileScene scene = read(with_length(0.99));
  EXPECT_THAT(scene.notes,
              ElementsAre("1 rotation of length other than 1 (0.990; /animations/0/samplers/1, key 1) normalised"));
  for (const NodeMotion& motion : scene.animations[0].nodes)
    for (const Eigen::Vector4d& q : motion.rotation.values) EXPECT_NEAR(q.norm(), 1.0, 1e-12);
  EXPECT_THAT(read(with_length(1.0005)).notes, IsEmpty());
  EXPECT_THAT(message_of(with_length(0.89)),
              HasSubstr("/animations/0/samplers/1, key 1: found a rotation of length 0.890"));
  EXPECT_THAT(message_of(with_length(0.0)), HasSubstr("a rotation of length 0.000, expected a unit quaternion"));

  GltfBody body({});
  body.maker.root["nodes"][0]["rotation"] = {0, 0, 0, 1.05};
  EXPECT_THAT(read(body.maker).notes,
              ElementsAre("1 rotation of length other than 1 (1.050; /nodes/0/rotation) normalised"));
  body.maker.root["nodes"][0]["rotation"] = {0, 0, 0, 2};
  EXPECT_THAT(message_of(body.maker), HasSubstr("/nodes/0/rotation: found a rotation of length 2.000"));
}

TEST(Gltf, NamesOfBuffersMayBeEscapedOrNot) {
  const GltfBody body({});
  const fs::path folder = scratch_folder();
  const std::size_t corners = scene_corners(read(body.maker), -1, 0.0).size();
  const std::pair<const char*, const char*> names[] = {{"buffer 11.bin", "buffer%2011.bin"},
                                                       {"buffer 12.bin", "buffer 12.bin"},
                                                       {"100%.bin", "100%.bin"},
                                                       {"50%25.bin", "50%25.bin"}, // not escaped, though it looks so
                                                       {"m\u00fctze.bin", "m%C3%BCtze.bin"},
                                                       {"data/b.bin", "data/b.bin"},
                                                       {"data/c.bin", "data\\c.bin"},
                                                       {"d.bin", "./d.bin"}};
  fs::create_directories(folder / "data");
  for (const auto& [name, uri] : names) {
    const fs::path file = body.maker.write_pair(folder / "body.gltf", name, uri);
    EXPECT_EQ(scene_corners(read_gltf(file), -1, 0.0).size(), corners) << uri;
    fs::remove(folder / name);
  }
}

TEST(Gltf, ColoursOfMaterials) {
  GltfBody body({});
  json& primitive = body.maker.root["meshes"][0]["primitives"][0];
  EXPECT_THAT(read(body.maker).meshes[0].colour, ElementsAre(0.8f, 0.8f, 0.8f));
  primitive["material"] = body.maker.add("materials", json::object());
  EXPECT_THAT(read(body.maker).meshes[0].colour, ElementsAre(1.0f, 1.0f, 1.0f));
  primitive["material"] =
      body.maker.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 2.0, 0.1}}}}});
  EXPECT_THAT(read(body.maker).meshes[0].colour, ElementsAre(0.25f, 0.5f, 1.0f));
}

TEST(Gltf, FormatsByWhatTheContentSays) {
  GltfBody body({});
  const fs::path folder = scratch_folder();
  EXPECT_EQ(read_gltf(GltfMaker::write(folder / "a.vrm", body.maker.glb())).format, "glTF 2.0 binary");
  EXPECT_EQ(read_gltf(GltfMaker::write(folder / "a.glb", body.maker.gltf())).format, "glTF 2.0");
  body.maker.root["extensions"]["VRM"] = {{"specVersion", "0.0"}};
  FileScene scene = read_gltf(GltfMaker::write(folder / "b.vrm", body.maker.glb()));
  EXPECT_EQ(scene.format, "VRM 0.x");
  EXPECT_THAT(scene.notes, ElementsAre("a character of VRM 0.x, which faces -Z"));
  body.maker.root["extensions"] = {{"VRMC_vrm", {{"specVersion", "1.0"}}}};
  body.maker.root["extensionsRequired"] = {"VRMC_vrm"};
  scene = read_gltf(GltfMaker::write(folder / "c.vrm", body.maker.glb()));
  EXPECT_EQ(scene.format, "VRM 1.0");
  EXPECT_THAT(scene.notes, IsEmpty());
}

TEST(Gltf, ByteOrderMarkAndZerosBehindTheJson) {
  const GltfBody body({});
  const fs::path folder = scratch_folder();
  EXPECT_EQ(read_gltf(GltfMaker::write(folder / "a.gltf", "\xef\xbb\xbf" + body.maker.gltf())).instances.size(), 1u);
  std::string glb = body.maker.glb();
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  for (std::size_t at = 20 + length - 1; glb[at] == ' '; --at) glb[at] = '\0';
  EXPECT_EQ(read_gltf(GltfMaker::write(folder / "b.glb", glb)).instances.size(), 1u);
}

TEST(Gltf, NamesThatAreNotUtf8AreReadAllTheSame) {
  GltfBody body({});
  std::string text = body.maker.gltf();
  text.replace(text.find("\"Armature\""), 10, "\"Arm\xe4ture\"");
  const FileScene scene = read_gltf(GltfMaker::write(scratch_folder() / "a.gltf", text));
  EXPECT_EQ(scene.nodes[1].name, "Arm_ture");
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_THAT(scene.notes, ElementsAre("names that are not UTF-8: _ stands for what is not"));
  text.insert(text.find("\"nodes\""), "x"); // and what is no JSON either
  EXPECT_THROW(read_gltf(GltfMaker::write(scratch_folder() / "b.gltf", text)), InputError);
}

TEST(Gltf, CompressedNormalsAndKhrNameOfMeshopt) {
  GltfBody body({.normals = {.component = k_int16, .normalized = true, .filter = "OCTAHEDRAL"}});
  body.maker.meshopt = true;
  body.maker.meshopt_name = "KHR_meshopt_compression";
  const FileScene scene = read(body.maker), known = read(GltfBody({}).maker);
  ASSERT_EQ(scene.meshes[0].normals.size(), known.meshes[0].normals.size());
  for (std::size_t v = 0; v < known.meshes[0].normals.size(); ++v)
    EXPECT_LT((scene.meshes[0].normals[v] - known.meshes[0].normals[v]).norm(), 1e-3f);
}

TEST(Gltf, WhatIsLeftOutIsNoted) {
  GltfBody body({});
  json& root = body.maker.root;
  root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", json::object()}};
  root["images"] = {{{"uri", "../secret.png"}}, {{"uri", "skin.png"}}, {{"uri", "data:image/png;base64,AAAA"}}};
  root["meshes"][0]["primitives"].push_back({{"attributes", json::object()}});
  EXPECT_THAT(read(body.maker).notes,
              ElementsAre("EXT_mesh_gpu_instancing is not read: what it draws many times is drawn once",
                          "1 primitive without positions, which draws nothing (/meshes/0/primitives/1)",
                          "1 texture outside of the file's folder not opened: ../secret.png"));
}

TEST(Gltf, NormalsThatAreNoNumbersAreLeftOut) {
  GltfBody body({});
  std::vector<double> normals(48 * 3, std::numeric_limits<double>::quiet_NaN());
  body.maker.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = body.maker.add_accessor(normals, "VEC3");
  const FileScene scene = read(body.maker);
  EXPECT_THAT(scene.meshes[0].normals, IsEmpty());
  EXPECT_THAT(scene.notes,
              Contains("1 primitive whose normals are no numbers, which are left out (/meshes/0/primitives/0)"));
}

} // namespace
