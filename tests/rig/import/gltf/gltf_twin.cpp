#include "tests/rig/import/gltf/gltf_twin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <draco/compression/decode.h>
#include <fstream>
#include <functional>
#include <iterator>
#include <meshoptimizer.h>
#include <stdexcept>

namespace tutu::test {
namespace {

using nlohmann::json;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("the twin finds no " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t little(const std::string& bytes, std::size_t at, std::size_t size) {
  std::size_t value = 0;
  for (std::size_t k = 0; k < size; ++k) value += std::size_t{static_cast<unsigned char>(bytes.at(at + k))} << (8 * k);
  return value;
}

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bits, bytes;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t digit = digits.find(c);
    for (int k = 5; k >= 0; --k) bits.push_back((digit >> k & 1) != 0 ? '1' : '0');
  }
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8)
    bytes.push_back(static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2)));
  return bytes;
}

std::string unescaped(std::string text) {
  for (std::size_t at = text.find('%'); at != text.npos; at = text.find('%', at + 1))
    text.replace(at, 3, 1, static_cast<char>(std::stoi(text.substr(at + 1, 2), nullptr, 16)));
  return text;
}

std::size_t size_of_component(int type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

/// One number as 3.6.2.2 and 3.11 have it.
double number_at(const std::string& bytes, std::size_t at, int type, bool normalized) {
  const std::size_t raw = little(bytes, at, size_of_component(type));
  switch (type) {
  case 5120: {
    const auto c = static_cast<double>(static_cast<std::int8_t>(raw));
    return normalized ? std::max(c / 127.0, -1.0) : c;
  }
  case 5121: return normalized ? static_cast<double>(raw) / 255.0 : static_cast<double>(raw);
  case 5122: {
    const auto c = static_cast<double>(static_cast<std::int16_t>(raw));
    return normalized ? std::max(c / 32767.0, -1.0) : c;
  }
  case 5123: return normalized ? static_cast<double>(raw) / 65535.0 : static_cast<double>(raw);
  case 5125: return static_cast<double>(raw);
  default: break;
  }
  const auto word = static_cast<std::uint32_t>(raw);
  float value = 0;
  std::memcpy(&value, &word, 4);
  return static_cast<double>(value);
}

Eigen::Matrix4d turned(const std::vector<double>& q) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  matrix.topLeftCorner<3, 3>() << 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), //
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),                             //
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y);
  return matrix;
}

void make_unit(std::vector<double>& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& c : q) c /= length;
}

} // namespace

GltfTwin::GltfTwin(const std::filesystem::path& file) : file_(file) {
  const std::string bytes = bytes_of(file);
  if (bytes.substr(0, 4) != "glTF") {
    root_ = json::parse(bytes);
    return;
  }
  const std::size_t length = little(bytes, 12, 4);
  root_ = json::parse(bytes.substr(20, length));
  if (20 + length < bytes.size()) binary_ = bytes.substr(20 + length + 8, little(bytes, 20 + length, 4));
}

const json& GltfTwin::list(const char* name) const {
  static const json none = json::array();
  return root_.contains(name) ? root_.at(name) : none;
}

bool GltfTwin::has_skin() const {
  return std::any_of(list("nodes").begin(), list("nodes").end(),
                     [](const json& node) { return node.contains("skin"); });
}

std::string GltfTwin::buffer(std::size_t index) const {
  const json& buffer = list("buffers").at(index);
  if (!buffer.contains("uri")) return binary_;
  const std::string uri = buffer.at("uri");
  if (uri.substr(0, 5) == "data:") return from_base64(uri.substr(uri.find(',') + 1));
  return bytes_of(file_.parent_path() / unescaped(uri));
}

const std::string& GltfTwin::view(std::size_t index) {
  const auto [found, is_new] = views_.try_emplace(index);
  if (!is_new) return found->second;
  const json& view = list("bufferViews").at(index);
  const json extensions = view.value("extensions", json::object());
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    if (!extensions.contains(name)) continue;
    const json& e = extensions.at(name);
    const std::string stream = buffer(e.at("buffer")).substr(e.value("byteOffset", 0u), e.at("byteLength"));
    const auto* from = reinterpret_cast<const unsigned char*>(stream.data());
    const std::size_t count = e.at("count"), stride = e.at("byteStride");
    const std::string mode = e.at("mode"), filter = e.value("filter", "NONE");
    std::string to(count * stride, '\0');
    const int failed = mode == "ATTRIBUTES" ? meshopt_decodeVertexBuffer(to.data(), count, stride, from, stream.size())
                       : mode == "TRIANGLES"
                           ? meshopt_decodeIndexBuffer(to.data(), count, stride, from, stream.size())
                           : meshopt_decodeIndexSequence(to.data(), count, stride, from, stream.size());
    if (failed != 0) throw std::runtime_error("the twin cannot decode a view");
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(to.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(to.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(to.data(), count, stride);
    return found->second = to;
  }
  return found->second = buffer(view.at("buffer")).substr(view.value("byteOffset", 0u), view.at("byteLength"));
}

const GltfTwin::Numbers& GltfTwin::accessor(std::size_t index) {
  const auto [found, is_new] = accessors_.try_emplace(index);
  if (!is_new) return found->second;
  const json& a = list("accessors").at(index);
  const std::string type = a.at("type");
  Numbers numbers;
  numbers.width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
  const std::size_t count = a.at("count");
  const int component = a.at("componentType");
  const std::size_t size = size_of_component(component);
  const bool normalized = a.value("normalized", false);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < numbers.width; ++k) {
      if (!a.contains("bufferView")) {
        numbers.all.push_back(0.0);
        continue;
      }
      const json& v = list("bufferViews").at(a.at("bufferView").get<std::size_t>());
      const std::size_t stride = v.value("byteStride", size * numbers.width);
      numbers.all.push_back(number_at(view(a.at("bufferView")),
                                      a.value("byteOffset", std::size_t{0}) + i * stride + k * size, component,
                                      normalized));
    }
  if (a.contains("sparse")) {
    const json &s = a.at("sparse"), &at = s.at("indices"), &values = s.at("values");
    const int index_type = at.at("componentType");
    for (std::size_t i = 0; i < s.at("count").get<std::size_t>(); ++i) {
      const std::size_t element =
          little(view(at.at("bufferView")), at.value("byteOffset", std::size_t{0}) + i * size_of_component(index_type),
                 size_of_component(index_type));
      for (std::size_t k = 0; k < numbers.width; ++k)
        numbers.all.at(element * numbers.width + k) = number_at(
            view(values.at("bufferView")), values.value("byteOffset", std::size_t{0}) + (i * numbers.width + k) * size,
            component, normalized);
    }
  }
  return found->second = numbers;
}

const GltfTwin::Compressed& GltfTwin::compressed(std::size_t mesh, std::size_t primitive) {
  const auto [found, is_new] = compressed_.try_emplace({mesh, primitive});
  if (!is_new) return found->second;
  const json& p = list("meshes").at(mesh).at("primitives").at(primitive);
  const json& e = p.at("extensions").at("KHR_draco_mesh_compression");
  const std::string& stream = view(e.at("bufferView"));
  draco::DecoderBuffer buffer;
  buffer.Init(stream.data(), stream.size());
  draco::Decoder decoder;
  const std::unique_ptr<draco::Mesh> decoded = decoder.DecodeMeshFromBuffer(&buffer).value();
  Compressed& made = found->second;
  for (std::uint32_t f = 0; f < decoded->num_faces(); ++f)
    for (int k = 0; k < 3; ++k)
      made.indices.push_back(decoded->face(draco::FaceIndex(f))[static_cast<std::size_t>(k)].value());
  for (const auto& [name, id] : e.at("attributes").items()) {
    const json& a = list("accessors").at(p.at("attributes").at(name).get<std::size_t>());
    const draco::PointAttribute& attribute = *decoded->GetAttributeByUniqueId(id.get<std::uint32_t>());
    const int component = a.at("componentType");
    Numbers& numbers = made.attributes[name];
    numbers.width = static_cast<std::size_t>(attribute.num_components());
    for (std::uint32_t v = 0; v < decoded->num_points(); ++v) {
      const std::uint8_t* value = attribute.GetAddressOfMappedIndex(draco::PointIndex(v));
      const std::string raw(reinterpret_cast<const char*>(value), numbers.width * size_of_component(component));
      for (std::size_t k = 0; k < numbers.width; ++k)
        numbers.all.push_back(
            number_at(raw, k * size_of_component(component), component, a.value("normalized", false)));
    }
  }
  return made;
}

double GltfTwin::end_of(std::size_t index) {
  const json& animation = list("animations").at(index);
  double end = 0.0;
  for (const json& channel : animation.at("channels")) {
    if (!channel.at("target").contains("node") || channel.at("target").at("path") == "weights") continue;
    const Numbers& times = accessor(animation.at("samplers").at(channel.at("sampler").get<std::size_t>()).at("input"));
    end = std::max(end, *std::max_element(times.all.begin(), times.all.end()));
  }
  return end;
}

std::vector<double> GltfTwin::sampled(const json& sampler, double time, bool is_rotation) {
  const Numbers &times = accessor(sampler.at("input")), &output = accessor(sampler.at("output"));
  const std::string law = sampler.value("interpolation", "LINEAR");
  const bool is_cubic = law == "CUBICSPLINE";
  const auto element = [&](std::size_t key, std::size_t part) {
    std::vector<double> values;
    for (std::size_t k = 0; k < output.width; ++k) values.push_back(output.at(is_cubic ? 3 * key + part : key, k));
    if (is_rotation && part == 1) make_unit(values); // what integers and three digits leave
    return values;
  };
  const std::size_t keys = times.count();
  if (time <= times.at(0, 0)) return element(0, 1);
  if (time >= times.at(keys - 1, 0)) return element(keys - 1, 1);
  std::size_t k = 0;
  while (times.at(k + 1, 0) <= time) ++k;
  const double step = times.at(k + 1, 0) - times.at(k, 0), t = (time - times.at(k, 0)) / step;
  const std::vector<double> a = element(k, 1), b = element(k + 1, 1);
  if (law == "STEP") return a;
  std::vector<double> result(output.width);
  if (is_cubic) { // C.5
    const std::vector<double> out = element(k, 2), in = element(k + 1, 0);
    for (std::size_t c = 0; c < result.size(); ++c)
      result[c] = (2 * t * t * t - 3 * t * t + 1) * a[c] + step * (t * t * t - 2 * t * t + t) * out[c] +
                  (-2 * t * t * t + 3 * t * t) * b[c] + step * (t * t * t - t * t) * in[c];
  } else if (is_rotation) { // C.4
    double d = 0;
    for (std::size_t c = 0; c < 4; ++c) d += a[c] * b[c];
    const double angle = std::acos(std::min(std::abs(d), 1.0)), sign = d < 0 ? -1.0 : 1.0;
    for (std::size_t c = 0; c < 4; ++c)
      result[c] = angle < 1e-9 ? a[c]
                               : std::sin(angle * (1 - t)) / std::sin(angle) * a[c] +
                                     sign * std::sin(angle * t) / std::sin(angle) * b[c];
  } else {
    for (std::size_t c = 0; c < result.size(); ++c) result[c] = (1 - t) * a[c] + t * b[c];
  }
  if (is_rotation) make_unit(result);
  return result;
}

std::vector<Eigen::Matrix4d> GltfTwin::globals(int animation, double time) {
  const json& nodes = list("nodes");
  std::vector<Matrix4> locals;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    std::map<std::string, std::vector<double>> properties = {
        {"translation", nodes[n].value("translation", std::vector<double>{0, 0, 0})},
        {"rotation", nodes[n].value("rotation", std::vector<double>{0, 0, 0, 1})},
        {"scale", nodes[n].value("scale", std::vector<double>{1, 1, 1})}};
    make_unit(properties["rotation"]);
    if (animation >= 0) {
      const json& chosen = list("animations").at(static_cast<std::size_t>(animation));
      for (const json& channel : chosen.at("channels")) {
        const json& target = channel.at("target");
        if (!target.contains("node") || target.at("node") != n || target.at("path") == "weights") continue;
        properties[target.at("path")] = sampled(chosen.at("samplers").at(channel.at("sampler").get<std::size_t>()),
                                                time, target.at("path") == "rotation");
      }
    }
    Matrix4 move = Matrix4::Identity(), size = Matrix4::Identity(), local;
    for (int k = 0; k < 3; ++k) {
      move(k, 3) = properties["translation"][static_cast<std::size_t>(k)];
      size(k, k) = properties["scale"][static_cast<std::size_t>(k)];
    }
    local = move * turned(properties["rotation"]) * size;
    if (nodes[n].contains("matrix"))
      for (int k = 0; k < 16; ++k) local(k % 4, k / 4) = nodes[n].at("matrix").at(static_cast<std::size_t>(k));
    locals.push_back(local);
  }
  std::vector<Matrix4> all(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    all[n] = locals[n];
    for (std::size_t at = n;;) { // up to the root
      std::size_t parent = nodes.size();
      for (std::size_t p = 0; p < nodes.size(); ++p)
        for (const json& child : nodes[p].value("children", json::array()))
          if (child == at) parent = p;
      if (parent == nodes.size()) break;
      all[n] = locals[parent] * all[n];
      at = parent;
    }
  }
  return all;
}

std::vector<std::size_t> GltfTwin::triangle_indices(const json& primitive, std::size_t vertices) {
  std::vector<std::size_t> from, all;
  if (primitive.contains("indices"))
    for (const double index : accessor(primitive.at("indices")).all) from.push_back(static_cast<std::size_t>(index));
  else
    for (std::size_t v = 0; v < vertices; ++v) from.push_back(v);
  const int mode = primitive.value("mode", 4);
  for (std::size_t i = 0; mode == 4 && i + 2 < from.size(); i += 3)
    all.insert(all.end(), {from[i], from[i + 1], from[i + 2]});
  for (std::size_t i = 0; mode >= 5 && i + 2 < from.size(); ++i) {
    if (mode == 5) all.insert(all.end(), {from[i], from[i + (1 + i % 2)], from[i + (2 - i % 2)]});
    else all.insert(all.end(), {from[i + 1], from[i + 2], from[0]});
  }
  return all;
}

std::vector<Vec3> GltfTwin::posed(std::size_t node, std::size_t primitive, const std::vector<Matrix4>& globals) {
  const json& from = list("nodes").at(node);
  const std::size_t m = from.at("mesh");
  const json &mesh = list("meshes").at(m), &p = mesh.at("primitives").at(primitive);
  const bool is_compressed = p.value("extensions", json::object()).contains("KHR_draco_mesh_compression");
  const auto attribute = [&](const std::string& name) -> const Numbers& {
    if (is_compressed)
      if (const auto& all = compressed(m, primitive).attributes; all.contains(name)) return all.at(name);
    return accessor(p.at("attributes").at(name));
  };
  const std::vector<double> weights = from.value("weights", mesh.value("weights", std::vector<double>()));
  const Numbers& positions = attribute("POSITION");
  std::vector<Vec3> points;
  for (std::size_t v = 0; v < positions.count(); ++v) {
    Vec3 point(positions.at(v, 0), positions.at(v, 1), positions.at(v, 2));
    for (std::size_t t = 0; t < weights.size(); ++t)
      if (const json& target = p.at("targets").at(t); target.contains("POSITION"))
        for (int k = 0; k < 3; ++k)
          point[k] += weights[t] * accessor(target.at("POSITION")).at(v, static_cast<std::size_t>(k));
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    const bool is_skinned = from.contains("skin") && p.at("attributes").contains("JOINTS_0");
    for (int set = 0; is_skinned && p.at("attributes").contains("JOINTS_" + std::to_string(set)); ++set) {
      const json& skin = list("skins").at(from.at("skin").get<std::size_t>());
      const Numbers &joints = attribute("JOINTS_" + std::to_string(set)),
                    &by = attribute("WEIGHTS_" + std::to_string(set));
      for (std::size_t k = 0; k < 4; ++k) {
        if (by.at(v, k) == 0.0) continue;
        const auto j = static_cast<std::size_t>(joints.at(v, k));
        Matrix4 bind = Matrix4::Identity();
        if (skin.contains("inverseBindMatrices"))
          for (int e = 0; e < 16; ++e)
            bind(e % 4, e / 4) = accessor(skin.at("inverseBindMatrices")).at(j, static_cast<std::size_t>(e));
        sum += by.at(v, k) * (globals.at(skin.at("joints").at(j)) * bind * point.homogeneous());
      }
    }
    if (!is_skinned) sum = globals.at(node) * point.homogeneous();
    points.emplace_back(sum.head<3>() / sum.w());
  }
  return points;
}

void GltfTwin::draw(std::size_t node, const std::vector<Matrix4>& globals, std::vector<Vec3>& to) {
  const json& from = list("nodes").at(node);
  if (from.contains("mesh")) {
    const std::size_t m = from.at("mesh");
    const json& primitives = list("meshes").at(m).at("primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const std::vector<Vec3> points = posed(node, p, globals);
      const bool is_compressed =
          primitives[p].value("extensions", json::object()).contains("KHR_draco_mesh_compression");
      for (const std::size_t v :
           is_compressed ? compressed(m, p).indices : triangle_indices(primitives[p], points.size()))
        to.push_back(points.at(v));
    }
  }
  for (const json& child : from.value("children", json::array())) draw(child, globals, to);
}

std::vector<Vec3> GltfTwin::corners(int animation, double time) {
  const std::vector<Matrix4> all = globals(animation, time);
  std::vector<Vec3> points;
  if (list("scenes").empty()) return points;
  for (const json& root : list("scenes").at(root_.value("scene", std::size_t{0})).value("nodes", json::array()))
    draw(root, all, points);
  return points;
}

} // namespace tutu::test
