// Streams of meshopt and Draco that are cut, claim too much, or do not fit what the JSON says of them.
#include "tests/rig/import/gltf/gltf_message.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::test;
using nlohmann::json;
using ::testing::HasSubstr;

namespace {

/// The JSON of a .glb, and the file with another.
json json_of(const std::string& glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  return json::parse(glb.substr(20, length));
}
std::string with_json(const std::string& glb, const json& root) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  const std::string body = glb.substr(20 + length);
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string file = "glTF";
  GltfMaker::append(file, std::uint32_t{2});
  GltfMaker::append(file, static_cast<std::uint32_t>(20 + text.size() + body.size()));
  GltfMaker::append(file, static_cast<std::uint32_t>(text.size()));
  return file + "JSON" + text + body;
}

TEST(GltfCompressed, AStreamOfMeshoptCutAtEveryByte) {
  const std::string glb = compressed_body(true, {}).maker.glb();
  const json root = json_of(glb);
  int streams = 0;
  for (std::size_t v = 0; v < root["bufferViews"].size(); ++v) {
    if (!root["bufferViews"][v].contains("extensions")) continue;
    ++streams;
    const std::size_t length = root["bufferViews"][v]["extensions"]["EXT_meshopt_compression"]["byteLength"];
    for (std::size_t size = 0; size < length; ++size) {
      json cut = root;
      cut["bufferViews"][v]["extensions"]["EXT_meshopt_compression"]["byteLength"] = size;
      EXPECT_THAT(message_of_bytes(with_json(glb, cut)), HasSubstr("EXT_meshopt_compression: a stream"))
          << v << ", " << size;
    }
  }
  EXPECT_GT(streams, 10);
}

TEST(GltfCompressed, LayoutsThatMeshoptDoesNotAllow) {
  const std::string glb = compressed_body(true, {}).maker.glb();
  const auto with = [&](const char* member, const json& value) {
    json root = json_of(glb);
    root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][member] = value;
    return message_of_bytes(with_json(glb, root));
  };
  EXPECT_EQ(with("byteStride", 12), "");
  for (const int stride : {0, 1, 13, 260})
    EXPECT_THAT(with("byteStride", stride), HasSubstr("do not go together")) << stride;
  EXPECT_THAT(with("filter", "OCTAHEDRAL"), HasSubstr("do not go together"));
  EXPECT_THAT(with("filter", "QUATERNION"), HasSubstr("do not go together"));
  EXPECT_THAT(with("filter", "COLOR"), HasSubstr("one that EXT_meshopt_compression has"));
  EXPECT_THAT(with("mode", "TRIANGLES"), HasSubstr("do not go together"));
  EXPECT_THAT(with("mode", "POINTS"), HasSubstr("one that EXT_meshopt_compression has"));
  EXPECT_THAT(with("count", 1'000'000'000), HasSubstr("for 1000000000 elements, which cannot be decoded"));
  EXPECT_THAT(with("count", 9e15), HasSubstr("which cannot be decoded"));
  std::string newer = glb;
  const json root = json_of(glb);
  const std::size_t start = root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteOffset"];
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  newer[28 + length + start] = '\xa1';
  EXPECT_THAT(message_of_bytes(newer), HasSubstr("a stream of version 1, which is not read"));
}

TEST(GltfCompressed, AStreamOfDracoCutAtEveryByte) {
  for (const int method : {0, 1}) {
    const std::string glb = compressed_body(false, method).maker.glb();
    const json root = json_of(glb);
    const std::size_t v = root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"];
    const std::size_t length = root["bufferViews"][v]["byteLength"];
    for (std::size_t size = 0; size < length; ++size) {
      json cut = root;
      cut["bufferViews"][v]["byteLength"] = size;
      EXPECT_THAT(message_of_bytes(with_json(glb, cut)), HasSubstr("KHR_draco_mesh_compression: "))
          << method << ", " << size;
    }
  }
}

TEST(GltfCompressed, AStreamOfDracoThatClaimsTooMuch) {
  for (const int method : {0, 1}) {
    std::string glb = compressed_body(false, method).maker.glb();
    const std::size_t start = glb.find("DRACO");
    ASSERT_NE(start, std::string::npos);
    const std::size_t numbers = start + (method == 0 ? 11 : 12);
    for (std::size_t k = 0; k < 4; ++k) glb[numbers + k] = '\xff';
    glb[numbers + 4] = '\x0f'; // 2^32 - 1
    EXPECT_THAT(message_of_bytes(glb), HasSubstr("4,294,967,295")) << method;
  }
}

TEST(GltfCompressed, AttributesThatDracoHasNot) {
  const auto with = [](const char* place, const json& value) {
    GltfBody body = compressed_body(false, 0);
    body.maker
        .root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"][json::json_pointer(place)] =
        value;
    return message_of(body.maker);
  };
  EXPECT_THAT(with("/attributes/POSITION", 77), HasSubstr("KHR_draco_mesh_compression: no attribute 77"));
  EXPECT_THAT(with("/attributes/POSITION", 1e12), HasSubstr("no attribute"));
  EXPECT_THAT(with("/attributes/POSITION", 1), HasSubstr("4 components, expected 3"));
  EXPECT_THAT(with("/bufferView", 99), HasSubstr("/bufferView: found 99"));
}

} // namespace
