// Files of glTF that are damaged, cut, circular, or claim more than they hold: read, or one message, and nothing else.
#include "tests/rig/import/gltf/gltf_message.h"
#include "tests/rig/import/other_process.h"
#include "tests/support/paths.h"

#include <chrono>
#include <cstdlib>
#include <functional>
#include <gmock/gmock.h>
#include <random>

using namespace tutu;
using namespace tutu::test;
using nlohmann::json;
using rig::import_detail::read_gltf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

/// The message of the plain body, one thing of it changed.
template <typename Change> std::string changed(const Change& change, const BodyOptions& options = {}) {
  GltfBody body(options);
  change(body.maker.root, body.maker);
  return message_of(body.maker);
}

TEST(GltfHostile, NothingAndNoise) {
  EXPECT_THAT(message_of_bytes("", "a.gltf"), HasSubstr("found no JSON, expected glTF 2.0"));
  EXPECT_THAT(message_of_bytes("noise", "a.gltf"), HasSubstr("line 1, column 2: found syntax error"));
  EXPECT_THAT(message_of_bytes("{\"a\":\n [1,}", "a.gltf"), HasSubstr("line 2, column"));
  EXPECT_THAT(message_of_bytes("[]", "a.gltf"), HasSubstr("JSON that is no object"));
  EXPECT_THAT(message_of_bytes("{}", "a.gltf"), HasSubstr("/: found no \"asset\", expected it to be given"));
  EXPECT_THAT(message_of_bytes(R"({"asset":{"version":"2.0"},"asset":{}})", "a.gltf"),
              HasSubstr("key \"asset\": found it twice"));
  EXPECT_THAT(message_of_bytes("{\"asset\":1e999}", "a.gltf"), HasSubstr("expected JSON"));
  EXPECT_THAT(message_of_bytes("{\"asset\":" + std::string(5'000'000, '['), "a.gltf"),
              HasSubstr("more than 128 levels of nesting"));
  std::string deep = R"({"asset":{"version":"2.0"},"extras":)" + std::string(2'000'000, '{');
  EXPECT_NE(message_of_bytes(deep, "a.gltf"), "");
  EXPECT_EQ(message_of_bytes(R"({"asset":{"version":"2.0"}})", "a.gltf"), "");
  EXPECT_THAT(message_of_bytes("{\"asset\":{\"version\":\"2.0\"},\"ill-formed UTF-8\x01", "a.gltf"),
              HasSubstr("found text that cannot be read, expected JSON"));
  EXPECT_THAT(message_of_bytes("glTF", "a.glb"), HasSubstr("a binary glTF of 4 bytes"));
}

TEST(GltfHostile, Versions) {
  EXPECT_THAT(changed([](json& root, auto&) { root["asset"]["version"] = "1.0"; }),
              HasSubstr("/asset/version: found \"1.0\", expected glTF 2.0"));
  EXPECT_EQ(changed([](json& root, auto&) { root["asset"]["version"] = "2.1"; }), "");
  EXPECT_THAT(changed([](json& root, auto&) { root["asset"]["version"] = 2; }), HasSubstr("expected a string"));
  EXPECT_THAT(changed([](json& root, auto&) { root["asset"]["minVersion"] = "2.1"; }), HasSubstr("/asset/minVersion"));
  std::string old = GltfBody({}).maker.glb();
  old[4] = 1;
  EXPECT_THAT(message_of_bytes(old), HasSubstr("version 1 of binary glTF, expected version 2"));
}

TEST(GltfHostile, ARequiredExtensionThatIsNotRead) {
  const auto required = [](const char* name) {
    return changed([&](json& root, auto&) { root["extensionsRequired"] = {name}; });
  };
  EXPECT_THAT(required("ACME_squashed_geometry"),
              HasSubstr("requires the extension ACME_squashed_geometry, which is not read"));
  EXPECT_THAT(required("EXT_mesh_gpu_instancing"), HasSubstr("which is not read"));
  EXPECT_THAT(required("KHR_animation_pointer"), HasSubstr("which is not read"));
  for (const char* fine : {"KHR_mesh_quantization", "KHR_materials_unlit", "KHR_texture_transform", "EXT_texture_webp",
                           "KHR_texture_basisu", "VRM", "VRMC_springBone", "KHR_lights_punctual"})
    EXPECT_EQ(required(fine), "") << fine;
}

TEST(GltfHostile, GraphsThatAreNoTree) {
  EXPECT_THAT(changed([](json& root, auto&) { root["nodes"][4]["children"] = {3}; }),
              HasSubstr("node 3 as a child of node 1 and of node 4, expected a node with one parent"));
  EXPECT_THAT(changed([](json& root, auto&) {
                root["nodes"][7]["children"].erase(0); // the hips
                root["nodes"][4]["children"] = {0};
              }),
              HasSubstr("/nodes/0: found a node that is its own ancestor"));
  EXPECT_THAT(changed([](json& root, auto&) {
                root["nodes"].push_back({{"children", {8}}});
              }),
              HasSubstr("/nodes/8: found a node that is its own ancestor"));
  EXPECT_THAT(changed([](json& root, auto&) { root["nodes"][4]["children"] = {7}; }), // the scene's root
              HasSubstr("/scenes/0/nodes/0: found node 7, a child of node 4"));
  EXPECT_THAT(changed([](json& root, auto&) { root["nodes"][4]["children"] = {5, 5}; }), HasSubstr("one parent"));
}

TEST(GltfHostile, ADeepChainOfNodesIsRead) {
  GltfBody body({});
  for (int i = 0; i < 50'000; ++i) body.maker.root["nodes"].push_back({{"children", {9 + i}}});
  body.maker.root["nodes"].push_back({{"name", "last"}});
  EXPECT_EQ(message_of(body.maker), "");
}

TEST(GltfHostile, IndicesOutOfRange) {
  const std::pair<const char*, json> places[] = {{"/scene", 7},
                                                 {"/scenes/0/nodes/0", 99},
                                                 {"/nodes/0/children/0", 99},
                                                 {"/nodes/6/mesh", 4},
                                                 {"/nodes/6/skin", 4},
                                                 {"/skins/0/joints/2", 99},
                                                 {"/skins/0/inverseBindMatrices", 99},
                                                 {"/meshes/0/primitives/0/attributes/POSITION", 99},
                                                 {"/meshes/0/primitives/0/attributes/JOINTS_0", 99},
                                                 {"/meshes/0/primitives/0/indices", 99},
                                                 {"/meshes/0/primitives/0/material", 0},
                                                 {"/animations/0/channels/0/sampler", 99},
                                                 {"/animations/0/channels/0/target/node", 99},
                                                 {"/animations/0/samplers/0/input", 99},
                                                 {"/animations/0/samplers/0/output", 99},
                                                 {"/accessors/0/bufferView", 99},
                                                 {"/bufferViews/0/buffer", 3}};
  for (const auto& [place, index] : places)
    for (const json& bad : {index, json(-1), json(0.5), json("0"), json(1e30), json::array({0})}) {
      const std::string pointer = place;
      const std::string message = changed([&](json& root, GltfMaker& maker) {
        if (pointer == "/bufferViews/0/buffer") maker.meshopt = false;
        root[json::json_pointer(pointer)] = bad;
      });
      if (pointer == "/bufferViews/0/buffer" && message.empty()) continue; // the maker may set it right
      EXPECT_THAT(message, HasSubstr(": " + pointer + ": found")) << bad;
    }
}

TEST(GltfHostile, EveryMemberOfEveryOtherType) {
  // Each value of the file in turn is replaced by one of another type, or left out.
  const GltfBody body({.morph = 0.5, .sparse_morph = true});
  std::vector<json::json_pointer> places;
  const std::function<void(const json&, const json::json_pointer&)> walk = [&](const json& value,
                                                                               const json::json_pointer& at) {
    if (!at.empty()) places.push_back(at);
    if (value.is_object())
      for (const auto& [key, member] : value.items()) walk(member, at / key);
    if (value.is_array())
      for (std::size_t i = 0; i < value.size(); ++i) walk(value[i], at / i);
  };
  walk(body.maker.root, json::json_pointer());
  EXPECT_GT(places.size(), 250u);
  int refused = 0, tried = 0;
  for (const json::json_pointer& place : places)
    for (const json& other :
         {json(nullptr), json(true), json(-3), json(1e18), json("text"), json::array(), json::object()}) {
      GltfMaker maker = body.maker;
      if (place == json::json_pointer("/bufferViews") || place.parent_pointer() == json::json_pointer("/bufferViews"))
        continue; // the maker needs them
      maker.root[place] = other;
      ++tried;
      refused += message_of(maker).empty() ? 0 : 1;
    }
  EXPECT_GT(refused, tried / 2);
}

TEST(GltfHostile, WeightsAndJoints) {
  const auto message = [](const char* attribute, std::vector<double> numbers, Component component) {
    return changed([&](json& root, GltfMaker& maker) {
      numbers.resize(48 * 4, 0.0);
      root["meshes"][0]["primitives"][0]["attributes"][attribute] =
          maker.add_accessor(numbers, "VEC4", {.component = component});
    });
  };
  EXPECT_THAT(message("WEIGHTS_0", {1, 0, 0, 0, -0.5}, k_float), HasSubstr("found weight -0.500000 for vertex 1"));
  EXPECT_THAT(message("WEIGHTS_0", {std::numeric_limits<double>::quiet_NaN()}, k_float),
              HasSubstr("found weight nan for vertex 0"));
  EXPECT_THAT(message("JOINTS_0", {0, 0, 0, 0, 9}, k_uint8),
              HasSubstr("/meshes/0/primitives/0: found joint index 9 for vertex 1, expected an index below 6"));
  EXPECT_EQ(message("JOINTS_0", {0, 0, 9, 0, 0, 0}, k_uint8), ""); // with weight 0
  EXPECT_THAT(message("JOINTS_0", {0}, k_float), HasSubstr("numbers that are no indices"));
  EXPECT_THAT(
      changed([](json& root, GltfMaker&) { root["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0"); }),
      HasSubstr("JOINTS_0 without WEIGHTS_0"));
  EXPECT_THAT(changed([](json& root, GltfMaker& maker) {
                root["skins"][0]["inverseBindMatrices"] = maker.add_accessor(std::vector<double>(5 * 16, 0.0), "MAT4");
              }),
              HasSubstr("found 5 inverse binds, expected 6, one a joint"));
  EXPECT_THAT(changed([](json& root, GltfMaker&) { root["skins"][0]["joints"] = json::array(); }),
              HasSubstr("no joint"));
}

TEST(GltfHostile, NumbersThatAreNone) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {infinity, nan, 3e38}) {
    const auto with = [&](const char* type, std::size_t count, const char* place) {
      return changed([&](json& root, GltfMaker& maker) {
        std::vector<double> numbers(count, 0.5);
        numbers[count / 2] = bad;
        root[json::json_pointer(place)] = maker.add_accessor(numbers, type);
      });
    };
    EXPECT_THAT(with("VEC3", 144, "/meshes/0/primitives/0/attributes/POSITION"),
                HasSubstr("a position that is no number, of vertex 24"));
    EXPECT_THAT(with("MAT4", 96, "/skins/0/inverseBindMatrices"), HasSubstr("inverse bind"));
    EXPECT_THAT(with("SCALAR", 3, "/animations/0/samplers/0/input"), HasSubstr("no number"));
    EXPECT_THAT(with("VEC3", 9, "/animations/0/samplers/0/output"), HasSubstr("no number"));
    EXPECT_NE(with("VEC4", 16, "/animations/0/samplers/1/output"), "");
  }
  EXPECT_THAT(changed([](json& root, auto&) {
                root["nodes"][0]["translation"] = {0, 1e300, 0};
              }),
              HasSubstr("/nodes/0/translation/1"));
  EXPECT_THAT(changed([](json& root, auto&) {
                root["nodes"][0]["translation"] = {0, 1};
              }),
              HasSubstr("an array of 3 numbers"));
  EXPECT_THAT(
      changed([](json& root, auto&) { root["nodes"][5]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }),
      HasSubstr("a matrix besides a translation"));
}

TEST(GltfHostile, SamplersThatDoNotFit) {
  EXPECT_THAT(changed([](json& root, auto&) { root["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE"; }),
              HasSubstr("found 3 values for 3 keys, expected 9"));
  EXPECT_THAT(changed([](json& root, auto&) { root["animations"][0]["samplers"][0]["interpolation"] = "BOUNCE"; }),
              HasSubstr("found \"BOUNCE\", expected STEP, LINEAR or CUBICSPLINE"));
  EXPECT_THAT(changed([](json& root, auto&) {
                json& channels = root["animations"][0]["channels"];
                channels.push_back(channels[1]);
              }),
              HasSubstr("/animations/0/channels/4: found a second channel for the rotation of node 3, besides "
                        "/animations/0/channels/1"));
  EXPECT_THAT(changed([](json& root, auto&) {
                root["animations"][0]["samplers"][0]["output"] = root["animations"][0]["samplers"][1]["output"];
              }),
              HasSubstr("found \"VEC4\", expected \"VEC3\""));
}

TEST(GltfHostile, CountsBeyondAllBytes) {
  const auto start = std::chrono::steady_clock::now();
  const GltfBody body({.normals = {.is_sparse = true}, .morph = 0.5});
  for (std::size_t a = 0; a < body.maker.root["accessors"].size(); ++a) {
    const std::size_t own = body.maker.root["accessors"][a]["count"];
    for (const std::size_t count : {own + 1, std::size_t{1'000'000'000}, std::size_t{1} << 52}) {
      GltfMaker maker = body.maker;
      maker.root["accessors"][a]["count"] = count;
      EXPECT_THAT(message_of(maker), HasSubstr("elements within a view")) << a << ", " << count;
      if (count == own + 1) continue;
      maker.root["accessors"][a].erase("bufferView");
      EXPECT_THAT(message_of(maker), HasSubstr("elements without a buffer view")) << a << ", " << count;
    }
  }
  EXPECT_THAT(
      changed([](json& root, auto&) {
        root["accessors"][0].erase("bufferView");
        root["accessors"][0]["count"] = 1'000'000'000;
      }),
      HasSubstr("/accessors/0: found 1,000,000,000 elements without a buffer view, expected at most 4,194,304"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(GltfHostile, ASmallFileThatDescribesAHugeScene) {
  // In a process of its own: others of this one would count the memory that it keeps.
  const auto message = [](const std::function<void(json&)>& change) {
    return message_in_process([&] {
      ::setenv("TUTU_MEMORY_GIB", "0.25", 1);
      GltfBody body({});
      change(body.maker.root);
      read_gltf(GltfMaker::write(scratch_folder() / "huge.glb", body.maker.glb()));
    });
  };
  // Ten thousand primitives of 48 MB of zeros each.
  EXPECT_THAT(message([](json& root) {
                root["accessors"].push_back({{"componentType", k_float}, {"count", 4'000'000}, {"type", "VEC3"}});
                json& primitives = root["meshes"][0]["primitives"];
                primitives = json::array();
                const auto last = root["accessors"].size() - 1;
                for (int i = 0; i < 10'000; ++i)
                  primitives.push_back({{"attributes", {{"POSITION", last}}}, {"mode", 0}});
              }),
              HasSubstr("what buffers and accessors describe"));
  // A mesh of a thousand primitives under fifty thousand nodes.
  EXPECT_THAT(message([](json& root) {
                json& primitives = root["meshes"][0]["primitives"];
                for (int i = 0; i < 999; ++i) primitives.push_back(json(primitives[0]));
                const json node = {{"mesh", 0}, {"skin", 0}};
                for (int i = 0; i < 50'000; ++i) {
                  root["scenes"][0]["nodes"].push_back(root["nodes"].size());
                  root["nodes"].push_back(node);
                }
              }),
              HasSubstr("what buffers and accessors describe"));
}

TEST(GltfHostile, NamesThatLeadOutOfTheFolder) {
  const fs::path folder = scratch_folder();
  GltfMaker::write(folder / "secret.bin", std::string(100'000, '\0'));
  for (const char* name :
       {"../secret.bin", "%2e%2e/secret.bin", "..%2fsecret.bin", "..\\secret.bin", "/etc/passwd", "file:///etc/passwd",
        "http://example.org/a.bin", "C:/a.bin", "a/../../secret.bin", "%2Fetc%2Fpasswd"}) {
    const GltfBody body({});
    const std::string message = message_of(body.maker.write_pair(folder / "in" / "body.gltf", "b.bin", name));
    EXPECT_THAT(message, HasSubstr("/buffers/0/uri: found")) << name;
    EXPECT_THAT(message, HasSubstr("outside of its folder")) << name;
  }
  const GltfBody body({});
  EXPECT_THAT(message_of(body.maker.write_pair(folder / "in" / "body.gltf", "b.bin", "none.bin")),
              HasSubstr("no such file: none.bin"));
  EXPECT_THAT(message_of(body.maker.write_pair(folder / "in" / "body.gltf", "b.bin", std::string("b.bin\0c", 7))),
              HasSubstr("zero in it"));
  EXPECT_THAT(message_of(body.maker.write_pair(folder / "in" / "body.gltf", "b.bin", "b.bin%00")),
              HasSubstr("zero in it"));
  GltfMaker::write(folder / "in" / "short.bin", "abc");
  EXPECT_THAT(message_of(body.maker.write_pair(folder / "in" / "body.gltf", "b.bin", "short.bin")),
              HasSubstr("/buffers/0: found 3 bytes"));
}

TEST(GltfHostile, DataThatIsNoBase64) {
  const auto message = [](const std::string& uri) {
    GltfBody body({});
    std::string text = body.maker.gltf();
    const std::size_t start = text.find("data:"), end = text.find('"', start);
    return message_of_bytes(text.replace(start, end - start, uri), "a.gltf");
  };
  EXPECT_THAT(message("data:,abc"), HasSubstr("data in base64"));
  EXPECT_THAT(message("data:a;base64,@@@@"), HasSubstr("a character that is none of base64"));
  EXPECT_THAT(message("data:a;base64,AAAA"), HasSubstr("found 3 bytes, expected byteLength"));
  EXPECT_THAT(message("data:"), HasSubstr("data in base64"));
}

TEST(GltfHostile, CutAnywhere) {
  for (const GltfBody& body :
       {GltfBody({}), compressed_body(true, {}), compressed_body(false, 0), compressed_body(false, 1)}) {
    const std::string whole = body.maker.glb();
    ASSERT_EQ(message_of_bytes(whole), "");
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_NE(message_of_bytes(std::string_view(whole).substr(0, size)), "") << size;
  }
  // Not binary: what is cut is no JSON any more.
  const std::string text = GltfBody({}).maker.gltf();
  for (std::size_t size = 0; size + 1 < text.size(); size += 7)
    EXPECT_NE(message_of_bytes(std::string_view(text).substr(0, size), "a.gltf"), "") << size;
}

TEST(GltfHostile, FlippedBits_slow) {
  std::mt19937_64 random(15);
  for (const GltfBody& body :
       {GltfBody({}), compressed_body(true, {}), compressed_body(false, 0), compressed_body(false, 1)}) {
    const std::string whole = body.maker.glb();
    std::uint32_t length = 0;
    std::memcpy(&length, whole.data() + 12, 4);
    int refused = 0;
    constexpr int k_tries = 3000;
    for (int i = 0; i < k_tries; ++i) {
      std::string bytes = whole;
      // In the buffer as often as in the JSON, which is longer.
      const std::size_t first = i % 2 == 0 ? 0 : 20 + length, size = i % 2 == 0 ? bytes.size() : bytes.size() - first;
      for (int flips = 1 + i % 4; flips > 0; --flips) {
        char& byte = bytes[first + random() % size];
        byte = static_cast<char>(byte ^ 1 << random() % 8);
      }
      refused += message_of_bytes(bytes).empty() ? 0 : 1;
    }
    EXPECT_GT(refused, k_tries / 10); // the flips do damage
    EXPECT_LT(refused, k_tries * 9 / 10);
  }
}

TEST(GltfHostile, ModelsOfAssimpThatAreRefused) {
  const std::pair<const char*, const char*> refused[] = {
      {"glTF/BoxTextured-glTF/BoxTextured.gltf", "found \"1.0\", expected glTF 2.0"},
      {"glTF/BoxTextured-glTF-Binary/BoxTextured.glb", "version 1 of binary glTF"},
      {"glTF2/TestNoRootNode/NoScene.gltf", "/scene: found 0, expected an index below 0"},
      {"glTF2/SchemaFailures/sceneWrongType.gltf", "/scene: found \"hello\""},
      {"glTF2/IndexOutOfRange/IndexOutOfRange.gltf", "found vertex index 255, expected an index below 24"},
      {"glTF2/wrongTypes/badArray.gltf", "/meshes/0/primitives: found an object, expected an array"},
      {"glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "a position that is no number, of vertex 0"},
      {"glTF2/RecursiveNodes/RecursiveNodes.gltf", "nodes without a parent"},
      {"glTF2/MissingBin/BoxTextured.gltf", "no such file: BoxTextured0.bin"}};
  for (const auto& [name, message] : refused) EXPECT_THAT(message_of(assimp_model(name)), HasSubstr(message)) << name;
}

} // namespace
