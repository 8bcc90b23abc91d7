#include "rig/import/gltf/nodes.h"

#include <algorithm>
#include <cmath>

namespace tutu::rig::import_detail {
namespace {

constexpr std::size_t k_most_nodes = 100'000;
constexpr std::size_t k_none = static_cast<std::size_t>(-1);

/// Sixteen numbers, column by column. Its last row is 0 0 0 1 but for what rounding explains.
Affine affine_of(const double* columns, const GltfValue& place, const std::string& what) {
  constexpr double k_rounding = 1e-4;
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(columns);
  if (!(matrix.array().abs() <= k_largest_number).all())
    throw place.error(what + " that is no number", "finite numbers");
  if (!((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).array().abs() <= k_rounding).all())
    throw place.error(what + " with a last row other than 0 0 0 1", "an affine transform");
  Affine affine = Affine::Identity();
  affine.affine() = matrix.topRows<3>();
  return affine;
}

Affine local_of(const GltfValue& node, GltfRotations& rotations) {
  const auto translation = node.find("translation"), rotation = node.find("rotation"), scale = node.find("scale");
  if (const std::optional<GltfValue> matrix = node.find("matrix")) {
    if (translation || rotation || scale)
      throw node.error("a matrix besides a translation, rotation or scale", "one or the other");
    return affine_of(matrix->numbers(16).data(), *matrix, "a matrix");
  }
  const auto vector = [](const std::optional<GltfValue>& value, const Vec3& instead) {
    return value ? Vec3(Eigen::Map<const Vec3>(value->numbers(3).data())) : instead;
  };
  Affine local = Affine::Identity();
  local.translate(vector(translation, Vec3::Zero()));
  if (rotation) {
    const std::vector<double> q = rotation->numbers(4);
    local.rotate(Quat(
        rotations.unit(Eigen::Map<const Eigen::Vector4d>(q.data()), GltfRotations::k_rounding, rotation->pointer())));
  }
  local.scale(vector(scale, Vec3::Ones()));
  return local;
}

/// Who is whose child, checked.
class Tree {
public:
  explicit Tree(const GltfDocument& document)
      : document_(document), nodes_(document.root().items("nodes")), parents_(nodes_.size(), k_none),
        children_(nodes_.size()) {
    if (nodes_.size() > k_most_nodes)
      throw InputError(document.file(), "/nodes", std::to_string(nodes_.size()) + " nodes",
                       "at most " + std::to_string(k_most_nodes));
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (const GltfValue& child : nodes_[i].items("children")) {
        const std::size_t c = document.target_index(child, "nodes");
        if (parents_[c] != k_none)
          throw child.error("node " + std::to_string(c) + " as a child of node " + std::to_string(parents_[c]) +
                                " and of node " + std::to_string(i),
                            "a node with one parent");
        parents_[c] = i;
        children_[i].push_back(c);
      }
  }

  const GltfValue& node(std::size_t index) const { return nodes_[index]; }
  std::size_t size() const { return nodes_.size(); }

  /// The default scene's, in its order.
  std::vector<std::size_t> drawn_roots() const {
    const std::optional<GltfValue> chosen = document_.root().find("scene");
    if (!chosen && document_.count("scenes") == 0) return all_roots();
    const GltfValue scene = chosen ? document_.target(*chosen, "scenes") : document_.root().at("scenes").item(0);
    std::vector<std::size_t> roots;
    std::vector<bool> is_listed(nodes_.size(), false);
    for (const GltfValue& reference : scene.items("nodes")) {
      const std::size_t node = document_.target_index(reference, "nodes");
      if (parents_[node] != k_none)
        throw reference.error("node " + std::to_string(node) + ", a child of node " + std::to_string(parents_[node]),
                              "nodes without a parent");
      if (!is_listed[node]) roots.push_back(node);
      is_listed[node] = true;
    }
    return roots;
  }
  std::vector<std::size_t> all_roots() const {
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (parents_[i] == k_none) roots.push_back(i);
    return roots;
  }

  /// Calls visit(node, parent), parent before child and children in order, for all below a root.
  template <typename Visit> void walk(std::size_t root, const Visit& visit) const {
    std::vector<std::size_t> open = {root};
    while (!open.empty()) {
      const std::size_t node = open.back();
      open.pop_back();
      visit(node, parents_[node]);
      open.insert(open.end(), children_[node].rbegin(), children_[node].rend());
    }
  }

private:
  const GltfDocument& document_;
  std::vector<GltfValue> nodes_;
  std::vector<std::size_t> parents_;
  std::vector<std::vector<std::size_t>> children_;
};

} // namespace

GltfNodes read_nodes(const GltfDocument& document, GltfRotations& rotations, FileScene& scene) {
  const Tree tree(document);
  GltfNodes nodes;
  nodes.node_of.assign(tree.size(), -1);
  scene.nodes.assign(1, FileNode{});
  bool has_copies = false;
  const auto add = [&](std::size_t index, std::size_t parent) {
    const GltfValue& from = tree.node(index);
    FileNode node;
    node.name = from.text_or("name", "");
    if (node.name.empty()) node.name = "node " + std::to_string(index);
    node.parent = parent == k_none ? 0 : nodes.node_of[parent];
    node.local = local_of(from, rotations);
    node.is_aid = from.find("camera") || from.extension("KHR_lights_punctual");
    has_copies |= from.extension("EXT_mesh_gpu_instancing").has_value();
    nodes.node_of[index] = static_cast<int>(scene.nodes.size());
    scene.nodes.push_back(std::move(node));
  };
  std::vector<bool> is_hidden(tree.size(), false); // with all below it [KHR_node_visibility]
  for (const std::size_t root : tree.drawn_roots())
    tree.walk(root, [&](std::size_t node, std::size_t parent) {
      add(node, parent);
      const auto visibility = tree.node(node).extension("KHR_node_visibility");
      is_hidden[node] =
          (parent != k_none && is_hidden[parent]) || (visibility && !visibility->flag_or("visible", true));
      if (!is_hidden[node]) nodes.drawn.push_back(node);
    });
  for (const std::size_t root : tree.all_roots())
    if (nodes.node_of[root] < 0) tree.walk(root, add);
  // What no root leads to leads to itself.
  if (const auto lost = std::find(nodes.node_of.begin(), nodes.node_of.end(), -1); lost != nodes.node_of.end())
    throw tree.node(static_cast<std::size_t>(lost - nodes.node_of.begin()))
        .error("a node that is its own ancestor", "a tree of nodes");
  if (has_copies) scene.notes.push_back("EXT_mesh_gpu_instancing is not read: what it draws many times is drawn once");
  return nodes;
}

const std::vector<Binding>& GltfSkins::skin(const GltfValue& reference) {
  const GltfDocument& document = accessors_.document();
  std::optional<std::vector<Binding>>& skin = skins_[document.target_index(reference, "skins")];
  if (skin) return *skin;
  const GltfValue from = document.target(reference, "skins");
  const GltfValue joints = from.at("joints");
  if (joints.size() == 0) throw joints.error("no joint", "at least one");
  std::vector<Binding> bindings;
  for (const GltfValue& joint : joints.items())
    bindings.push_back({nodes_.node_of[document.target_index(joint, "nodes")], Affine::Identity()});
  if (const std::optional<GltfValue> matrices = from.find("inverseBindMatrices")) {
    const GltfElements elements = accessors_.elements(*matrices, "MAT4");
    if (elements.count < bindings.size())
      throw matrices->error(std::to_string(elements.count) + " inverse binds",
                            std::to_string(bindings.size()) + ", one a joint");
    accessors_.memory().take(elements.numbers() * sizeof(double), elements.place);
    std::vector<double> numbers(elements.numbers());
    read_numbers(elements, numbers.data());
    for (std::size_t k = 0; k < bindings.size(); ++k)
      bindings[k].inverse_bind = affine_of(&numbers[16 * k], *matrices, "inverse bind " + std::to_string(k));
  }
  skin = std::move(bindings);
  return *skin;
}

} // namespace tutu::rig::import_detail
