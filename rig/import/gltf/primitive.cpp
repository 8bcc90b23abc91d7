#include "rig/import/gltf/primitive.h"

#include "rig/import/gltf/draco.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace tutu::rig::import_detail {
namespace {

enum class Mode { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

/// Reads the parts of one primitive; each attribute from its accessor, or from the compressed geometry that has it.
class PrimitiveReader {
public:
  PrimitiveReader(const GltfValue& primitive, GltfAccessors& accessors)
      : primitive_(primitive), attributes_(primitive.at("attributes")), accessors_(accessors),
        mode_(static_cast<Mode>(primitive.whole_or("mode", 4))) {
    if (primitive.whole_or("mode", 4) > 6) throw primitive.at("mode").error("0 to 6");
    if (const std::optional<GltfValue> draco = primitive.extension("KHR_draco_mesh_compression"))
      draco_ = std::make_unique<DracoGeometry>(*draco, accessors);
    made_.place = primitive.pointer();
  }

  GltfPrimitive read(const std::vector<double>& weights) {
    if (!attributes_.find("POSITION")) {
      made_.notes.emplace_back("without positions, which draws nothing");
      return std::move(made_);
    }
    made_.mesh.positions = vectors(attribute("POSITION", "VEC3"));
    vertices_ = made_.mesh.positions.size();
    if (attributes_.find("NORMAL")) made_.mesh.normals = vectors(attribute("NORMAL", "VEC3"));
    add_targets(weights);
    check_positions();
    drop_broken_normals();
    add_influences();
    add_triangles();
    return std::move(made_);
  }

private:
  GltfElements attribute(const std::string& name, std::string_view type) {
    const GltfValue reference = attributes_.at(name);
    const GltfElements elements =
        draco_ && draco_->has(name) ? draco_->elements(name, reference, type) : accessors_.elements(reference, type);
    if (name != "POSITION" && elements.count != vertices_)
      throw reference.error(std::to_string(elements.count) + " elements",
                            std::to_string(vertices_) + ", as many as positions");
    return elements;
  }

  std::vector<Vec3f> vectors(const GltfElements& elements) {
    accessors_.memory().take(elements.count * sizeof(Vec3f), elements.place);
    std::vector<Vec3f> all(elements.count);
    if (!all.empty()) read_numbers(elements, all.front().data()); // three floats each, packed
    return all;
  }

  void add_targets(const std::vector<double>& weights) {
    const std::vector<GltfValue> targets = primitive_.items("targets");
    for (std::size_t t = 0; t < weights.size(); ++t) {
      if (weights[t] == 0.0) continue;
      if (t >= targets.size())
        throw primitive_.error("a weight for morph target " + std::to_string(t) + " of " +
                                   std::to_string(targets.size()),
                               "weights for targets that are there");
      ++made_.morphed;
      add_target(targets[t], "POSITION", weights[t], made_.mesh.positions);
      if (!made_.mesh.normals.empty()) add_target(targets[t], "NORMAL", weights[t], made_.mesh.normals);
    }
  }
  void add_target(const GltfValue& target, const char* name, double weight, std::vector<Vec3f>& to) {
    const std::optional<GltfValue> reference = target.find(name);
    if (!reference) return;
    const std::vector<Vec3f> deltas = vectors(accessors_.elements(*reference, "VEC3"));
    if (deltas.size() != to.size())
      throw reference->error(std::to_string(deltas.size()) + " elements",
                             std::to_string(to.size()) + ", as many as positions");
    for (std::size_t v = 0; v < to.size(); ++v) to[v] += static_cast<float>(weight) * deltas[v];
  }

  void check_positions() const {
    const auto is_good = [](const Vec3f& p) { return (p.array().abs() <= static_cast<float>(k_largest_number)).all(); };
    const auto& positions = made_.mesh.positions;
    const auto bad = std::find_if_not(positions.begin(), positions.end(), is_good);
    if (bad == positions.end()) return;
    throw attributes_.at("POSITION")
        .error("a position that is no number, of vertex " + std::to_string(bad - positions.begin()),
               "finite numbers within +-1e9");
  }
  /// They can be made anew.
  void drop_broken_normals() {
    const auto is_good = [](const Vec3f& n) { return (n.array().abs() <= static_cast<float>(k_largest_number)).all(); };
    if (std::all_of(made_.mesh.normals.begin(), made_.mesh.normals.end(), is_good)) return;
    made_.mesh.normals.clear();
    made_.notes.emplace_back("whose normals are no numbers, which are left out");
  }

  struct Set {
    std::vector<std::uint32_t> joints; ///< four a vertex
    std::vector<float> weights;        ///< likewise
  };
  void add_influences() {
    std::vector<Set> sets;
    for (std::string n = "0"; attributes_.find("JOINTS_" + n); n = std::to_string(sets.size())) {
      if (!attributes_.find("WEIGHTS_" + n)) throw attributes_.error("JOINTS_" + n + " without WEIGHTS_" + n, "both");
      sets.push_back(read_set(n));
    }
    if (sets.empty()) return;
    const auto count = [](const Set& set) {
      return std::count_if(set.weights.begin(), set.weights.end(), [](float w) { return w > 0.0f; });
    };
    std::size_t influences = 0;
    for (const Set& set : sets) influences += static_cast<std::size_t>(count(set));
    accessors_.memory().take(influences * sizeof(Influence) + vertices_ * sizeof(int), made_.place);
    made_.mesh.influences.reserve(influences);
    made_.mesh.first.reserve(vertices_ + 1);
    made_.mesh.first.push_back(0);
    for (std::size_t v = 0; v < vertices_; ++v) {
      for (const Set& set : sets)
        for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) add_influence(set.joints[k], set.weights[k], v);
      made_.mesh.first.push_back(static_cast<int>(made_.mesh.influences.size()));
    }
    if (!made_.mesh.influences.empty()) return;
    made_.mesh.first.clear();
    made_.notes.emplace_back("with joints, and no weight above 0");
  }
  Set read_set(const std::string& n) {
    const GltfElements joints = attribute("JOINTS_" + n, "VEC4"), weights = attribute("WEIGHTS_" + n, "VEC4");
    check_wholes(joints, attributes_.at("JOINTS_" + n));
    accessors_.memory().take((joints.numbers() + weights.numbers()) * sizeof(float), made_.place);
    Set set{std::vector<std::uint32_t>(joints.numbers()), std::vector<float>(weights.numbers())};
    read_wholes(joints, set.joints.data());
    read_numbers(weights, set.weights.data());
    return set;
  }
  void add_influence(std::uint32_t joint, float weight, std::size_t vertex) {
    if (!(weight >= 0.0f && weight <= static_cast<float>(k_largest_number)))
      throw attributes_.error("weight " + std::to_string(weight) + " for vertex " + std::to_string(vertex),
                              "a finite weight, not negative");
    if (weight == 0.0f) return;
    if (joint > made_.highest_joint) {
      made_.highest_joint = joint;
      made_.highest_joint_vertex = vertex;
    }
    made_.mesh.influences.push_back({static_cast<int>(std::min<std::uint32_t>(joint, 0x7fffffff)), weight});
  }

  static void check_wholes(const GltfElements& elements, const GltfValue& reference) {
    const bool is_good = !elements.normalized &&
                         (elements.component == GltfComponent::uint8 || elements.component == GltfComponent::uint16 ||
                          elements.component == GltfComponent::uint32);
    if (!is_good)
      throw reference.error("numbers that are no indices (" + elements.place + ")",
                            "unsigned integers, not normalised");
  }

  void add_triangles() {
    std::size_t count = vertices_;
    std::optional<GltfElements> elements;
    const std::optional<GltfValue> reference = primitive_.find("indices");
    if (draco_) count = 0;
    else if (reference) {
      elements = accessors_.elements(*reference, "SCALAR");
      check_wholes(*elements, *reference);
      count = elements->count;
    }
    if (mode_ < Mode::triangles && !draco_) {
      made_.mesh.loose = mode_ == Mode::lines ? count / 2 : mode_ == Mode::line_strip && count > 0 ? count - 1 : count;
      return;
    }
    accessors_.memory().take(count * sizeof(Triangle), made_.place);
    if (draco_) made_.mesh.triangles = draco_->triangles(); // whatever the mode, it holds triangles
    else if (mode_ == Mode::triangles) read_list(elements, count);
    else read_strip_or_fan(elements, count);
    check_triangles();
  }
  void read_list(const std::optional<GltfElements>& elements, std::size_t count) {
    std::vector<Triangle>& triangles = made_.mesh.triangles;
    triangles.resize((count + 2) / 3);
    if (count == 0) return;
    std::uint32_t* const indices = triangles.front().data(); // three each, packed
    if (elements) read_wholes(*elements, indices);
    else std::iota(indices, indices + count, 0u);
    if (count % 3 == 0) return;
    triangles.pop_back();
    made_.notes.emplace_back("whose indices are no multiple of 3, of which the last are left out");
  }
  /// [glTF 2.0, 3.7.2.1]
  void read_strip_or_fan(const std::optional<GltfElements>& elements, std::size_t count) {
    if (count < 3) return;
    accessors_.memory().take(count * sizeof(std::uint32_t), made_.place);
    std::vector<std::uint32_t> v(count);
    if (elements) read_wholes(*elements, v.data());
    else std::iota(v.begin(), v.end(), 0u);
    made_.mesh.triangles.reserve(count - 2);
    for (std::size_t i = 0; i + 2 < count; ++i)
      made_.mesh.triangles.push_back(mode_ == Mode::triangle_strip ? Triangle{v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]}
                                                                   : Triangle{v[i + 1], v[i + 2], v[0]});
  }
  void check_triangles() const {
    std::uint32_t highest = 0;
    for (const Triangle& t : made_.mesh.triangles) highest = std::max({highest, t[0], t[1], t[2]});
    if (made_.mesh.triangles.empty() || highest < vertices_) return;
    throw primitive_.error("vertex index " + std::to_string(highest), "an index below " + std::to_string(vertices_));
  }

  const GltfValue& primitive_;
  const GltfValue attributes_;
  GltfAccessors& accessors_;
  Mode mode_;
  std::unique_ptr<DracoGeometry> draco_;
  std::size_t vertices_ = 0;
  GltfPrimitive made_;
};

} // namespace

GltfPrimitive read_primitive(const GltfValue& primitive, const std::vector<double>& weights, GltfAccessors& accessors) {
  return PrimitiveReader(primitive, accessors).read(weights);
}

void keep_used_vertices(FileMesh& mesh) {
  constexpr std::uint32_t k_unused = 0xffffffff;
  std::vector<std::uint32_t> now(mesh.positions.size(), k_unused);
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) now[v] = 0;
  std::uint32_t used = 0;
  for (std::uint32_t& index : now)
    if (index != k_unused) index = used++;
  if (used == now.size()) return;

  std::vector<int> first;
  std::vector<Influence> influences;
  if (!mesh.first.empty()) first.push_back(0);
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (now[v] == k_unused) continue;
    mesh.positions[now[v]] = mesh.positions[v];
    if (!mesh.normals.empty()) mesh.normals[now[v]] = mesh.normals[v];
    if (mesh.first.empty()) continue;
    influences.insert(influences.end(), mesh.influences.begin() + mesh.first[v],
                      mesh.influences.begin() + mesh.first[v + 1]);
    first.push_back(static_cast<int>(influences.size()));
  }
  if (influences.empty()) first.clear();
  mesh.positions.resize(used);
  if (!mesh.normals.empty()) mesh.normals.resize(used);
  mesh.first = std::move(first);
  mesh.influences = std::move(influences);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& v : triangle) v = now[v];
}

} // namespace tutu::rig::import_detail
