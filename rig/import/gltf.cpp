// What assimp 5.2.5 does not tell of a glTF file: it drops weights that are negative or not a number, and joints that
// are not there, and follows the names of buffers anywhere. Only those names and JOINTS_n and WEIGHTS_n of skinned
// meshes are looked at; whatever is malformed beyond them is assimp's to judge.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/detail/reach.h"
#include "rig/io/file_io.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

namespace tutu::rig::import_detail {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Gltf {
  json root;
  std::vector<std::string> buffers;
};

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// The chunk that starts at `at` with its length and kind [glTF 2.0, 4.4.3]; `at` moves behind it.
std::string_view chunk(std::string_view bytes, std::size_t& at) {
  const std::size_t length = word(bytes, at);
  if (at + 8 > bytes.size()) return {};
  const std::string_view content = bytes.substr(at + 8, length);
  at += 8 + length;
  return content;
}

std::string from_base64(std::string_view text) {
  constexpr std::string_view k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t digit = k_digits.find(c);
    if (digit == k_digits.npos) continue;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<char>(bits >> count & 0xff));
  }
  return bytes;
}

/// Throws InputError on a name that leads out of the file's folder, whether or not anything is there.
std::string read_beside(const fs::path& file, const std::string& name, std::size_t buffer) {
  if (!Reach(file).holds_name(name))
    throw out_of_reach(file.string(), "/buffers/" + std::to_string(buffer) + "/uri", name);
  std::error_code error;
  const fs::path beside = file.parent_path() / name;
  return fs::is_regular_file(beside, error) ? read_file(beside) : std::string();
}

Gltf open_gltf(const fs::path& file) {
  const std::string bytes = read_file(file);
  Gltf gltf;
  std::string_view binary;
  if (bytes.starts_with("glTF")) {
    std::size_t at = 12;
    const std::string_view text = chunk(bytes, at);
    gltf.root = json::parse(text, nullptr, false);
    binary = chunk(bytes, at);
  } else {
    gltf.root = json::parse(bytes, nullptr, false);
  }
  if (!gltf.root.is_object()) return gltf;
  for (const json& buffer : gltf.root.value("buffers", json::array())) {
    const std::string uri = buffer.value("uri", "");
    if (uri.empty()) gltf.buffers.emplace_back(binary);
    else if (uri.starts_with("data:"))
      gltf.buffers.push_back(from_base64(std::string_view(uri).substr(std::min(uri.find(',') + 1, uri.size()))));
    else gltf.buffers.push_back(read_beside(file, uri, gltf.buffers.size()));
  }
  return gltf;
}

/// A VEC4 accessor as numbers, four an element; empty when it is anything else or beyond its buffer.
std::vector<double> four_each(const Gltf& gltf, std::size_t index) {
  const json& accessor = gltf.root.at("accessors").at(index);
  if (accessor.contains("sparse") || !accessor.contains("bufferView") || accessor.value("type", "") != "VEC4")
    return {};
  const json& view = gltf.root.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
  const std::string& bytes = gltf.buffers.at(view.at("buffer").get<std::size_t>());
  const int type = accessor.at("componentType").get<int>();
  const std::size_t size = type == 5126 ? 4 : type == 5123 ? 2 : type == 5121 ? 1 : 0;
  const std::size_t count = accessor.at("count").get<std::size_t>(), stride = view.value("byteStride", 4 * size);
  const std::size_t start = view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
  if (size == 0 || count == 0 || stride == 0 || start > bytes.size() || count > bytes.size() / stride + 1 ||
      start + (count - 1) * stride + 4 * size > bytes.size())
    return {};
  std::vector<double> values;
  for (std::size_t i = 0; i < 4 * count; ++i) {
    const char* at = bytes.data() + start + i / 4 * stride + i % 4 * size;
    float real = 0;
    std::uint16_t whole = 0;
    if (size == 4) std::memcpy(&real, at, 4);
    else if (size == 2) std::memcpy(&whole, at, 2);
    else whole = static_cast<unsigned char>(*at);
    values.push_back(size == 4 ? static_cast<double>(real) : static_cast<double>(whole));
  }
  return values;
}

void check_primitive(const Gltf& gltf, const json& attributes, std::size_t joints, const std::string& file,
                     const std::string& place) {
  for (const std::string set : {"0", "1"}) {
    if (!attributes.contains("JOINTS_" + set) || !attributes.contains("WEIGHTS_" + set)) continue;
    const std::vector<double> joint = four_each(gltf, attributes.at("JOINTS_" + set).get<std::size_t>());
    const std::vector<double> weight = four_each(gltf, attributes.at("WEIGHTS_" + set).get<std::size_t>());
    for (std::size_t i = 0; i < std::min(joint.size(), weight.size()); ++i) {
      const std::string vertex = " for vertex " + std::to_string(i / 4);
      if (!std::isfinite(weight[i]) || weight[i] < 0.0)
        throw InputError(file, place, "weight " + std::to_string(weight[i]) + vertex, "a finite weight, not negative");
      if (weight[i] > 0.0 && !(joint[i] < static_cast<double>(joints)))
        throw InputError(file, place, "joint index " + std::to_string(static_cast<long>(joint[i])) + vertex,
                         "an index below " + std::to_string(joints));
    }
  }
}

} // namespace

void check_gltf(const std::string& file) {
  try {
    const Gltf gltf = open_gltf(file);
    if (!gltf.root.is_object()) return;
    for (const json& node : gltf.root.value("nodes", json::array())) {
      if (!node.contains("mesh") || !node.contains("skin")) continue;
      const std::size_t joints = gltf.root.at("skins").at(node.at("skin").get<std::size_t>()).at("joints").size();
      const std::size_t mesh = node.at("mesh").get<std::size_t>();
      for (const json& primitive : gltf.root.at("meshes").at(mesh).at("primitives"))
        check_primitive(gltf, primitive.at("attributes"), joints, file, "mesh " + std::to_string(mesh));
    }
  } catch (const json::exception&) { // not what glTF looks like: assimp's to judge
  } catch (const std::out_of_range&) {
  }
}

} // namespace tutu::rig::import_detail
