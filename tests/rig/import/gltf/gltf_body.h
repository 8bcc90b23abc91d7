// A small body of boxes on six joints that moves for two seconds, stored in whatever way a test asks for.
#pragma once

#include "rig/math.h"
#include "tests/rig/import/gltf/gltf_maker.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <numbers>
#include <optional>

namespace tutu::test {

struct BodyOptions {
  Stored positions = {}, normals = {}, weights = {}, rotations = {}, translations = {};
  Component joints = k_uint8, indices = k_uint16;
  std::string law = "LINEAR";
  bool has_inverse_binds = true;
  bool has_indices = true;
  int mode = 4;                     ///< 4: a list; 5 and 6: a strip and a fan of the first box's side
  bool second_set = false;          ///< JOINTS_1 and WEIGHTS_1
  bool children_first = false;      ///< a parent's index is larger than its children's
  bool matrices = false;            ///< nodes that do not move have a matrix
  std::optional<double> morph = {}; ///< default weight of a target that lifts the head
  bool sparse_morph = false;
  std::optional<int> draco = {}; ///< encoding method
  bool quantized = false;        ///< positions are integers, put right by the inverse binds
};

class GltfBody {
public:
  static constexpr double k_height = 1.75;

  explicit GltfBody(const BodyOptions& options) : options_(options) {
    make_boxes();
    add_nodes();
    add_mesh();
    add_skin();
    add_animation();
  }

  GltfMaker maker;

  /// Index of the node of a joint: Hips, Spine, Head, RightArm, RightHand, LeftArm.
  int joint(int j) const { return options_.children_first ? k_joints - 1 - j : j; }
  static constexpr int k_joints = 6;
  int body_node = -1, armature_node = -1;

private:
  struct Box {
    int joint;
    Vec3 low, high;
  };
  static constexpr const char* k_names[k_joints] = {"Hips", "Spine", "Head", "RightArm", "RightHand", "LeftArm"};
  static constexpr int k_parents[k_joints] = {-1, 0, 1, 1, 3, 1};
  static Vec3 place(int j) { // in model space
    const Vec3 places[k_joints] = {{0, 0.95, 0},   {0, 1.2, 0},    {0, 1.5, 0},
                                   {-0.2, 1.4, 0}, {-0.5, 1.4, 0}, {0.2, 1.4, 0}};
    return places[j];
  }

  void make_boxes() {
    const Box boxes[] = {{0, {-0.15, 0.0, -0.1}, {0.15, 0.95, 0.1}},   {1, {-0.15, 0.95, -0.1}, {0.15, 1.45, 0.1}},
                         {2, {-0.1, 1.5, -0.1}, {0.1, k_height, 0.1}}, {3, {-0.5, 1.35, -0.05}, {-0.15, 1.45, 0.05}},
                         {4, {-0.7, 1.36, -0.04}, {-0.5, 1.44, 0.04}}, {5, {0.15, 1.35, -0.05}, {0.7, 1.45, 0.05}}};
    for (const Box& box : boxes) {
      const auto first = static_cast<std::uint32_t>(points_.size());
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 pick(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        points_.emplace_back(box.low + pick.cwiseProduct(box.high - box.low));
        normals_.emplace_back((points_.back() - 0.5 * (box.low + box.high)).normalized());
        const bool is_root_side = k_parents[box.joint] >= 0 && (corner & 1) == (box.joint == 5 ? 0 : 1);
        joints_.insert(joints_.end(), {1.0 * box.joint, 1.0 * std::max(k_parents[box.joint], 0), 0.0, 0.0});
        weights_.insert(weights_.end(), {is_root_side ? 0.6 : 1.0, is_root_side ? 0.4 : 0.0, 0.0, 0.0});
      }
      for (const std::uint32_t v :
           {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
        indices_.push_back(first + v);
    }
    if (options_.mode != 4) indices_ = {0, 1, 2, 3, 6, 7, 4};
    if (!options_.has_indices && options_.mode == 4) unroll();
  }
  void unroll() {
    std::vector<Vec3> points, normals;
    std::vector<double> joints, weights;
    for (const std::uint32_t v : indices_) {
      points.push_back(points_[v]);
      normals.push_back(normals_[v]);
      joints.insert(joints.end(), joints_.begin() + 4 * v, joints_.begin() + 4 * v + 4);
      weights.insert(weights.end(), weights_.begin() + 4 * v, weights_.begin() + 4 * v + 4);
    }
    points_ = points;
    normals_ = normals;
    joints_ = joints;
    weights_ = weights;
  }

  void add_nodes() {
    using nlohmann::json;
    std::vector<json> nodes(k_joints);
    for (int j = 0; j < k_joints; ++j) {
      json& node = nodes[static_cast<std::size_t>(joint(j))];
      node["name"] = k_names[j];
      const Vec3 from = place(j) - (k_parents[j] < 0 ? Vec3(Vec3::Zero()) : place(k_parents[j]));
      if (options_.matrices && (j == 2 || j == 4))
        node["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, from.x(), from.y(), from.z(), 1};
      else node["translation"] = {from.x(), from.y(), from.z()};
      for (int child = 0; child < k_joints; ++child)
        if (k_parents[child] == j) node["children"].push_back(joint(child));
    }
    for (json& node : nodes) maker.add("nodes", std::move(node));
    // A skinned node's own place means nothing.
    body_node = maker.add("nodes", {{"name", "Body"}, {"translation", {5, 6, 7}}});
    armature_node = maker.add("nodes", {{"name", "Armature"},
                                        {"rotation", {0, std::sin(0.2), 0, std::cos(0.2)}},
                                        {"translation", {0.1, 0, 0.2}},
                                        {"children", {joint(0), body_node}}});
    maker.add("scenes", {{"nodes", {armature_node}}});
    maker.root["scene"] = 0;
  }

  static std::vector<double> flat(const std::vector<Vec3>& vectors) {
    std::vector<double> numbers;
    for (const Vec3& v : vectors) numbers.insert(numbers.end(), v.begin(), v.end());
    return numbers;
  }

  /// Model space to what is stored: 2 m in each direction over the integers' range.
  std::vector<Vec3> stored_points() const {
    std::vector<Vec3> points = points_;
    if (options_.quantized)
      for (Vec3& p : points) p = options_.positions.normalized ? Vec3(p / 2.0) : Vec3(p * 1000.0);
    return points;
  }
  double unit() const { return !options_.quantized ? 1.0 : options_.positions.normalized ? 2.0 : 0.001; }

  void add_mesh() {
    using nlohmann::json;
    json primitive;
    if (options_.mode != 4) primitive["mode"] = options_.mode;
    if (options_.draco) add_draco(primitive);
    else add_plain(primitive);
    if (options_.morph) add_target(primitive);
    json mesh = {{"name", "body"}, {"primitives", {primitive}}};
    if (options_.morph) mesh["weights"] = {*options_.morph};
    maker.root["nodes"][static_cast<std::size_t>(body_node)]["mesh"] = maker.add("meshes", std::move(mesh));
  }

  void add_plain(nlohmann::json& primitive) {
    primitive["attributes"]["POSITION"] = maker.add_accessor(flat(stored_points()), "VEC3", options_.positions);
    primitive["attributes"]["NORMAL"] = maker.add_accessor(flat(normals_), "VEC3", options_.normals);
    if (options_.second_set) { // one influence in each
      std::vector<double> joints[2], weights[2];
      for (std::size_t i = 0; i < joints_.size(); i += 4)
        for (std::size_t s = 0; s < 2; ++s) {
          joints[s].insert(joints[s].end(), {joints_[i + s], 0, 0, 0});
          weights[s].insert(weights[s].end(), {weights_[i + s], 0, 0, 0});
        }
      for (std::size_t s = 0; s < 2; ++s) add_influences(primitive, std::to_string(s), joints[s], weights[s]);
    } else {
      add_influences(primitive, "0", joints_, weights_);
    }
    if (options_.has_indices)
      primitive["indices"] =
          maker.add_indices(indices_, options_.indices, options_.mode == 4 ? "TRIANGLES" : "INDICES");
  }
  void add_influences(nlohmann::json& primitive, const std::string& set, const std::vector<double>& joints,
                      const std::vector<double>& weights) {
    primitive["attributes"]["JOINTS_" + set] = maker.add_accessor(joints, "VEC4", {.component = options_.joints});
    primitive["attributes"]["WEIGHTS_" + set] = maker.add_accessor(weights, "VEC4", options_.weights);
  }

  void add_target(nlohmann::json& primitive) {
    std::vector<Vec3> deltas(points_.size(), Vec3::Zero());
    std::vector<double> moved;
    std::string indices;
    for (std::size_t v = 16; v < 24; ++v) { // the head
      deltas[v].y() = 0.2;
      moved.insert(moved.end(), {0.0, 0.2, 0.0});
      GltfMaker::append(indices, static_cast<std::uint8_t>(v));
    }
    int target = 0;
    if (options_.sparse_morph) {
      std::string values;
      for (const double number : moved) GltfMaker::append(values, number, k_float, false);
      target = maker.add(
          "accessors",
          {{"componentType", k_float},
           {"count", points_.size()},
           {"type", "VEC3"},
           {"sparse",
            {{"count", 8},
             {"indices", {{"bufferView", maker.add_view(indices, 0, 1, "PLAIN")}, {"componentType", k_uint8}}},
             {"values", {{"bufferView", maker.add_view(values, 0, 12, "ATTRIBUTES")}}}}}});
    } else {
      target = maker.add_accessor(flat(deltas), "VEC3");
    }
    primitive["targets"] = {{{"POSITION", target}}};
  }

  void add_draco(nlohmann::json& primitive) {
    draco::Mesh mesh;
    const auto count = static_cast<std::uint32_t>(points_.size());
    mesh.set_num_points(count);
    const auto add = [&]<typename T>(draco::GeometryAttribute::Type type, int width, draco::DataType stored,
                                     bool normalized, const std::vector<T>& numbers, Component component,
                                     const char* name) {
      draco::GeometryAttribute attribute;
      attribute.Init(type, nullptr, static_cast<std::uint8_t>(width), stored, normalized,
                     static_cast<std::int64_t>(sizeof(T)) * width, 0);
      const int id = mesh.AddAttribute(attribute, true, count);
      for (std::uint32_t v = 0; v < count; ++v)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v),
                                              &numbers[v * static_cast<std::size_t>(width)]);
      nlohmann::json accessor = {
          {"componentType", component}, {"count", count}, {"type", width == 3 ? "VEC3" : "VEC4"}};
      if (normalized) accessor["normalized"] = true;
      primitive["attributes"][name] = maker.add("accessors", std::move(accessor));
      primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"][name] = mesh.attribute(id)->unique_id();
    };
    const std::vector<double> numbers = flat(points_), directions = flat(normals_);
    std::vector<std::uint8_t> joints(joints_.begin(), joints_.end()), bytes;
    for (const double w : weights_) bytes.push_back(static_cast<std::uint8_t>(std::lround(w * 255)));
    add(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, false,
        std::vector<float>(numbers.begin(), numbers.end()), k_float, "POSITION");
    add(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8, false, joints, k_uint8, "JOINTS_0");
    if (options_.weights.component == k_uint8)
      add(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8, true, bytes, k_uint8, "WEIGHTS_0");
    else
      add(draco::GeometryAttribute::GENERIC, 4, draco::DT_FLOAT32, false,
          std::vector<float>(weights_.begin(), weights_.end()), k_float, "WEIGHTS_0");
    for (std::size_t i = 0; i < indices_.size(); i += 3)
      mesh.AddFace(
          {draco::PointIndex(indices_[i]), draco::PointIndex(indices_[i + 1]), draco::PointIndex(indices_[i + 2])});
    draco::Encoder encoder;
    encoder.SetEncodingMethod(*options_.draco);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok()) throw std::runtime_error("draco cannot encode the body");
    primitive["indices"] =
        maker.add("accessors", {{"componentType", k_uint16}, {"count", indices_.size()}, {"type", "SCALAR"}});
    primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"] =
        maker.add_view(std::string(buffer.data(), buffer.size()), 0, 1, "PLAIN");
    maker.root["extensionsRequired"].push_back("KHR_draco_mesh_compression");
  }

  void add_skin() {
    nlohmann::json skin;
    std::vector<double> binds;
    for (int j = 0; j < k_joints; ++j) {
      skin["joints"].push_back(joint(j));
      const Vec3 back = -place(j);
      const double u = unit();
      binds.insert(binds.end(), {u, 0, 0, 0, 0, u, 0, 0, 0, 0, u, 0, back.x(), back.y(), back.z(), 1});
    }
    if (options_.has_inverse_binds) skin["inverseBindMatrices"] = maker.add_accessor(binds, "MAT4");
    maker.root["nodes"][static_cast<std::size_t>(body_node)]["skin"] = maker.add("skins", std::move(skin));
  }

  void add_animation() {
    nlohmann::json animation = {{"name", "wave"}};
    const auto channel = [&](int node, const char* path, const std::vector<double>& times,
                             const std::vector<double>& values, const Stored& stored) {
      const std::size_t width = std::string(path) == "rotation" ? 4 : 3;
      std::vector<double> output = values;
      if (options_.law == "CUBICSPLINE") { // tangents that overshoot
        output.clear();
        for (std::size_t i = 0; i < values.size(); i += width)
          for (int part = 0; part < 3; ++part)
            for (std::size_t k = 0; k < width; ++k)
              output.push_back(part == 1   ? values[i + k]
                               : part == 0 ? 0.3 * values[i + k] - 0.1
                                           : 0.2 - 0.4 * values[i + k]);
      }
      const int input = maker.add_accessor(times, "SCALAR");
      const int to = maker.add_accessor(output, width == 4 ? "VEC4" : "VEC3", stored);
      animation["samplers"].push_back({{"input", input}, {"output", to}, {"interpolation", options_.law}});
      animation["channels"].push_back(
          {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    };
    const auto about = [](const Vec3& axis, std::initializer_list<double> degrees) {
      std::vector<double> numbers;
      for (const double angle : degrees) {
        const Quat q(Eigen::AngleAxisd(angle * std::numbers::pi / 180.0, axis.normalized()));
        numbers.insert(numbers.end(), {q.x(), q.y(), q.z(), q.w()});
      }
      return numbers;
    };
    channel(joint(0), "translation", {0.25, 1.0, 2.0}, {0, 0.95, 0, 0.3, 1.0, 0.1, 0.5, 0.9, -0.2},
            options_.translations);
    channel(joint(3), "rotation", {0, 0.5, 1.25, 2.0}, about({0.2, 0.3, 1}, {0, 40, -75, 20}), options_.rotations);
    std::vector<double> spine = about({1, 0.5, 0}, {0, 25, -10});
    for (std::size_t k = 4; k < 8; ++k) spine[k] = -spine[k]; // the same rotation, the other sign
    channel(joint(1), "rotation", {0, 0.9, 1.7}, spine, options_.rotations);
    channel(joint(5), "scale", {0, 1.5}, {1, 1, 1, 1.2, 0.8, 1.1}, {});
    maker.add("animations", std::move(animation));
  }

  BodyOptions options_;
  std::vector<Vec3> points_, normals_;
  std::vector<double> joints_, weights_; ///< four a vertex
  std::vector<std::uint32_t> indices_;
};

} // namespace tutu::test
