// Files of glTF 2.0 for tests: accessors of every kind, put into a file of every kind.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace tutu::test {

/// componentType.
enum Component : int { k_int8 = 5120, k_uint8, k_int16, k_uint16, k_uint32 = 5125, k_float = 5126 };

inline std::size_t size_of(Component component) { return component <= k_uint8 ? 1 : component <= k_uint16 ? 2 : 4; }

/// How an accessor is stored.
struct Stored {
  Component component = k_float;
  bool normalized = false;
  std::size_t gap = 0;          ///< bytes between elements
  bool is_sparse = false;       ///< every other element is in the sparse part, and wrong in the dense one
  bool has_dense_part = true;   ///< false: what is not sparse is zero, and has no bytes
  const char* filter = nullptr; ///< of meshopt
};

class GltfMaker {
public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}};
  bool meshopt = false; ///< views are compressed when the file is put together
  std::string meshopt_name = "EXT_meshopt_compression";

  template <typename T> static void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  static void append(std::string& bytes, double value, Component component, bool normalized) {
    const auto whole = [&](auto type) {
      const double largest = normalized ? std::numeric_limits<decltype(type)>::max() : 1.0;
      append(bytes, static_cast<decltype(type)>(std::lround(value * largest)));
    };
    switch (component) {
    case k_int8: return whole(std::int8_t{});
    case k_uint8: return whole(std::uint8_t{});
    case k_int16: return whole(std::int16_t{});
    case k_uint16: return whole(std::uint16_t{});
    case k_uint32: return append(bytes, static_cast<std::uint32_t>(value));
    case k_float: return append(bytes, static_cast<float>(value));
    }
  }

  /// An element of one of the lists on top; its index.
  int add(const char* list, nlohmann::json element) {
    root[list].push_back(std::move(element));
    return static_cast<int>(root[list].size()) - 1;
  }

  int add_view(std::string bytes, std::size_t stride, std::size_t element, const char* mode,
               const char* filter = nullptr) {
    nlohmann::json view = {{"buffer", 0}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    views_.push_back({std::move(bytes), element, mode, filter});
    return add("bufferViews", std::move(view));
  }

  /// Of numbers one after the other; its index.
  int add_accessor(const std::vector<double>& numbers, const std::string& type, const Stored& stored = {}) {
    const std::size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
    const std::size_t count = numbers.size() / width, size = width * size_of(stored.component);
    nlohmann::json accessor = {{"componentType", stored.component}, {"count", count}, {"type", type}};
    if (stored.normalized) accessor["normalized"] = true;
    if (stored.filter) {
      accessor["bufferView"] = add_filtered(numbers, width, stored.filter);
      return add("accessors", std::move(accessor));
    }
    std::string dense, sparse, indices;
    std::uint16_t replaced = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_other = stored.is_sparse && i % 2 == 1;
      for (std::size_t k = 0; k < width; ++k) {
        append(dense, is_other ? 0.25 : numbers[i * width + k], stored.component, stored.normalized);
        if (is_other) append(sparse, numbers[i * width + k], stored.component, stored.normalized);
      }
      dense.append(stored.gap, '\x7f');
      if (!is_other) continue;
      append(indices, static_cast<std::uint16_t>(i));
      ++replaced;
    }
    if (stored.has_dense_part)
      accessor["bufferView"] =
          add_view(std::move(dense), stored.gap ? size + stored.gap : 0, size + stored.gap, "ATTRIBUTES");
    if (stored.is_sparse)
      accessor["sparse"] = {
          {"count", replaced},
          {"indices", {{"bufferView", add_view(std::move(indices), 0, 2, "INDICES")}, {"componentType", k_uint16}}},
          {"values", {{"bufferView", add_view(std::move(sparse), 0, size, "ATTRIBUTES")}}}};
    return add("accessors", std::move(accessor));
  }

  /// `mode`: how meshopt stores them, where it does.
  int add_indices(const std::vector<std::uint32_t>& indices, Component component, const char* mode = "TRIANGLES") {
    std::string bytes;
    for (const std::uint32_t index : indices) append(bytes, index, component, false);
    const int view = add_view(std::move(bytes), 0, size_of(component), mode);
    return add("accessors",
               {{"bufferView", view}, {"componentType", component}, {"count", indices.size()}, {"type", "SCALAR"}});
  }

  std::string glb() const {
    nlohmann::json all = root;
    std::string body = put_together(all);
    if (!meshopt) all["buffers"] = {{{"byteLength", body.size()}}};
    std::string text = all.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    body.resize((body.size() + 3) / 4 * 4, '\0');
    std::string file = "glTF";
    append(file, std::uint32_t{2});
    append(file, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + body.size()));
    append(file, static_cast<std::uint32_t>(text.size()));
    file += "JSON" + text;
    append(file, static_cast<std::uint32_t>(body.size()));
    return file + std::string("BIN\0", 4) + body;
  }
  /// With the buffer inside.
  std::string gltf() const {
    nlohmann::json all = root;
    const std::string body = put_together(all);
    const nlohmann::json uri = "data:application/octet-stream;base64," + base64(body);
    if (meshopt) all["buffers"][0]["uri"] = uri;
    else all["buffers"] = {{{"byteLength", body.size()}, {"uri", uri}}};
    return all.dump(1);
  }
  /// With the buffer beside it, in `name`, which the file writes as `uri`.
  std::filesystem::path write_pair(const std::filesystem::path& file, const std::string& name,
                                   const std::string& uri) const {
    nlohmann::json all = root;
    const std::string body = put_together(all);
    all["buffers"] = {{{"byteLength", body.size()}, {"uri", uri}}};
    write(file.parent_path() / name, body);
    return write(file, all.dump());
  }
  static std::filesystem::path write(const std::filesystem::path& file, const std::string& bytes) {
    std::filesystem::create_directories(file.parent_path());
    std::filesystem::remove(
        file); // what is cut to nothing and written anew, some file systems bring to the disk at once
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return file;
  }

private:
  struct View {
    std::string bytes;
    std::size_t element; ///< bytes of one, with its gap
    std::string mode;
    const char* filter;
  };

  int add_filtered(const std::vector<double>& numbers, std::size_t width, const std::string& filter) {
    const std::vector<float> reals(numbers.begin(), numbers.end());
    const std::size_t count = numbers.size() / width, size = filter == "EXPONENTIAL" ? 4 * width : 8;
    std::string bytes(count * size, '\0');
    if (filter == "QUATERNION") meshopt_encodeFilterQuat(bytes.data(), count, size, 16, reals.data());
    if (filter == "EXPONENTIAL") meshopt_encodeFilterExp(bytes.data(), count, size, 23, reals.data());
    if (filter == "OCTAHEDRAL") { // of three numbers, in four
      std::vector<float> padded;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 4; ++k) padded.push_back(k < 3 ? reals[3 * i + k] : 0.0f);
      meshopt_encodeFilterOct(bytes.data(), count, size, 16, padded.data());
    }
    const char* name = filter == "QUATERNION" ? "QUATERNION" : filter == "EXPONENTIAL" ? "EXPONENTIAL" : "OCTAHEDRAL";
    return add_view(std::move(bytes), filter == "OCTAHEDRAL" ? 8 : 0, size, "ATTRIBUTES", name);
  }

  /// The buffer, and what the JSON says of it.
  std::string put_together(nlohmann::json& all) const {
    std::string body;
    std::size_t plain = 0;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      nlohmann::json& view = all["bufferViews"][v];
      body.resize((body.size() + 3) / 4 * 4, '\0');
      // What the vertex codec cannot hold stays as it is.
      const bool is_compressed = meshopt && (views_[v].mode != "ATTRIBUTES" || views_[v].element % 4 == 0) &&
                                 (views_[v].mode == "ATTRIBUTES" || views_[v].element >= 2) &&
                                 views_[v].mode != "PLAIN";
      if (!is_compressed) {
        view["byteOffset"] = body.size();
        body += views_[v].bytes;
        continue;
      }
      const std::string stream = encoded(views_[v]);
      nlohmann::json extension = {{"buffer", 0},
                                  {"byteOffset", body.size()},
                                  {"byteLength", stream.size()},
                                  {"byteStride", views_[v].element},
                                  {"count", views_[v].bytes.size() / views_[v].element},
                                  {"mode", views_[v].mode}};
      if (views_[v].filter) extension["filter"] = views_[v].filter;
      view["buffer"] = 1;
      view["byteOffset"] = plain;
      plain += (views_[v].bytes.size() + 3) / 4 * 4;
      view["extensions"][meshopt_name] = std::move(extension);
      body += stream;
    }
    if (!meshopt) return body;
    all["buffers"] = {{{"byteLength", body.size()}},
                      {{"byteLength", plain}, {"extensions", {{meshopt_name, {{"fallback", true}}}}}}};
    all["extensionsRequired"].push_back(meshopt_name);
    return body;
  }

  static std::string encoded(const View& view) {
    const std::size_t count = view.bytes.size() / view.element;
    std::vector<unsigned char> stream;
    if (view.mode == "ATTRIBUTES") {
      stream.resize(meshopt_encodeVertexBufferBound(count, view.element));
      stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), view.bytes.data(), count, view.element));
    } else {
      std::vector<unsigned> indices;
      for (std::size_t i = 0; i < count; ++i) {
        unsigned index = 0;
        std::memcpy(&index, view.bytes.data() + i * view.element, view.element);
        indices.push_back(index);
      }
      const unsigned most = *std::max_element(indices.begin(), indices.end()) + 1;
      const bool is_list = view.mode == "TRIANGLES";
      stream.resize(is_list ? meshopt_encodeIndexBufferBound(count, most)
                            : meshopt_encodeIndexSequenceBound(count, most));
      stream.resize(is_list ? meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), count)
                            : meshopt_encodeIndexSequence(stream.data(), stream.size(), indices.data(), count));
    }
    if (stream.empty()) throw std::runtime_error("meshopt cannot encode a view");
    return {stream.begin(), stream.end()};
  }

  static std::string base64(const std::string& bytes) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k)
        bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
      for (std::size_t k = 0; k < 4; ++k)
        text.push_back(i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63]);
    }
    return text;
  }

  std::vector<View> views_;
};

} // namespace tutu::test
