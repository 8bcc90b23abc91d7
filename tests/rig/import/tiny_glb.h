// A rigged .glb of a few vertices, whole or with one thing wrong.
#pragma once

#include <cstdint>
#include <string>

namespace tutu::test {

struct GlbFlaw { ///< of the last vertex; the defaults are right
  float last_weight = 1.0f;
  std::uint16_t last_joint = 1;
  std::uint16_t last_index = 2;
  float last_height = 1.7f;
};

/// One triangle from the floor to 1.7 m; Hips at 1 m, Head 0.5 m above, moved by an animation.
inline std::string tiny_glb(const GlbFlaw& flaw = {}) {
  std::string data;
  const auto add = [&](auto value) { data.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const float x : {-0.2f, 0.0f, 0.0f, 0.2f, 0.0f, 0.0f, 0.0f}) add(x); // 0: positions
  add(flaw.last_height);
  add(0.1f);
  data.append(8 * sizeof(std::uint16_t), 0); // 36: joints, all Hips
  for (const std::uint16_t joint : {flaw.last_joint, std::uint16_t{0}, std::uint16_t{0}, std::uint16_t{0}}) add(joint);
  for (const float weight : {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, flaw.last_weight, 0.0f, 0.0f, 0.0f})
    add(weight);                          // 60
  for (const float down : {-1.0f, -1.5f}) // 108: inverse binds, columns
    for (const float m :
         {1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, down, 0.0f, 1.0f})
      add(m);
  for (const float time : {0.0f, 1.0f}) add(time);                   // 236: key times
  for (const float x : {0.0f, 1.0f, 0.0f, 0.5f, 1.0f, 0.0f}) add(x); // 244: translations
  for (const std::uint16_t index : {std::uint16_t{0}, std::uint16_t{1}, flaw.last_index, std::uint16_t{0}})
    add(index); // 268
  std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,2]}],
"nodes":[{"name":"Hips","translation":[0,1,0],"children":[1]},{"name":"Head","translation":[0,0.5,0]},{"name":"Body","mesh":0,"skin":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2},"indices":6}]}],
"skins":[{"joints":[0,1],"inverseBindMatrices":3}],
"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":4,"output":5}]}],
"buffers":[{"byteLength":276}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
{"buffer":0,"byteOffset":60,"byteLength":48},{"buffer":0,"byteOffset":108,"byteLength":128},{"buffer":0,"byteOffset":236,"byteLength":8},
{"buffer":0,"byteOffset":244,"byteLength":24},{"buffer":0,"byteOffset":268,"byteLength":8}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":3,"type":"VEC4"},
{"bufferView":2,"componentType":5126,"count":3,"type":"VEC4"},{"bufferView":3,"componentType":5126,"count":2,"type":"MAT4"},
{"bufferView":4,"componentType":5126,"count":2,"type":"SCALAR"},{"bufferView":5,"componentType":5126,"count":2,"type":"VEC3"},
{"bufferView":6,"componentType":5123,"count":3,"type":"SCALAR"}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string body;
  body.swap(data);
  const auto chunk = [&](std::uint32_t length, const char* kind, const std::string& bytes) {
    add(length);
    data += std::string(kind, 4) + bytes;
  };
  data = "glTF";
  add(std::uint32_t{2});
  add(static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + body.size()));
  chunk(static_cast<std::uint32_t>(json.size()), "JSON", json);
  chunk(static_cast<std::uint32_t>(body.size()), "BIN\0", body);
  return data;
}

} // namespace tutu::test
