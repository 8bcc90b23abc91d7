// Which nodes are joints, and which of them are one joint.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_same_place = 1e-4;    ///< of the skeleton's size: joints nearer than this coincide
constexpr double k_same_rotation = 1e-3; ///< rad
constexpr std::size_t k_most_joints = 10'000;

bool coincide(const Node& a, const Node& b, double tolerance) {
  return (a.global.translation() - b.global.translation()).norm() <= tolerance &&
         a.split.rotation.angularDistance(b.split.rotation) <= k_same_rotation;
}

/// Size of the skeleton, in the file's unit.
double extent(const std::vector<Node>& nodes, const std::vector<bool>& joint) {
  Eigen::AlignedBox3d box;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (joint[n]) box.extend(nodes[n].global.translation());
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

/// The nodes that bones name, and their twins: where a format tells names only, a bone may mean any node of its name
/// and place.
std::vector<bool> bone_nodes(const std::vector<Node>& nodes, const std::vector<Surface>& surfaces) {
  std::vector<bool> bone(nodes.size(), false);
  for (const Surface& surface : surfaces)
    for (const Binding& binding : surface.bindings) bone[binding.node] = true;
  const double tolerance = k_same_place * extent(nodes, bone);
  std::multimap<std::string_view, std::size_t> named;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (bone[n]) named.emplace(nodes[n].name, n);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (bone[n] || nodes[n].holds_mesh || nodes[n].is_aid) continue;
    const auto [begin, end] = named.equal_range(nodes[n].name);
    bone[n] =
        std::any_of(begin, end, [&](const auto& other) { return coincide(nodes[n], nodes[other.second], tolerance); });
  }
  return bone;
}

/// `flag` of a node or of anything below it.
std::vector<bool> below(const std::vector<Node>& nodes, std::vector<bool> flag) {
  for (std::size_t n = nodes.size(); n-- > 1;)
    if (flag[n]) flag[nodes[n].parent] = true;
  return flag;
}

/// Containers above the topmost bones that are joints all the same: those an animation moves, and the one that joins
/// several topmost bones of different names with nothing but joints below it (the unskinned root of one skeleton).
std::vector<bool> promoted_containers(const FileScene& scene, const std::vector<Node>& nodes,
                                      const std::vector<bool>& bone) {
  const std::vector<bool> has_bone = below(nodes, bone);
  std::vector<bool> inside(nodes.size(), false), scenery(nodes.size(), false);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    inside[n] = bone[n] || (nodes[n].parent >= 0 && inside[nodes[n].parent]);
    scenery[n] = !inside[n] && (nodes[n].holds_mesh || nodes[n].is_aid);
  }
  scenery = below(nodes, scenery);
  std::vector<std::set<std::string>> tops(nodes.size()); // names of the topmost bones below
  std::vector<int> branches(nodes.size(), 0);
  for (std::size_t n = nodes.size(); n-- > 1;) {
    const int parent = nodes[n].parent;
    if (!has_bone[n] || inside[parent]) continue;
    if (inside[n]) tops[n] = {nodes[n].name};
    ++branches[parent];
    tops[parent].insert(tops[n].begin(), tops[n].end());
  }
  std::vector<bool> promoted(nodes.size(), false);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (inside[n] || !has_bone[n]) continue;
    const bool joins = nodes[n].parent >= 0 && branches[n] >= 2 && tops[n].size() >= 2 && !scenery[n];
    promoted[n] = joins || is_moved(scene, nodes, static_cast<int>(n));
  }
  return promoted;
}

std::vector<bool> joint_nodes(const FileScene& scene, const std::vector<Node>& nodes,
                              const std::vector<Surface>& surfaces) {
  const std::vector<bool> bone = bone_nodes(nodes, surfaces), has_bone = below(nodes, bone);
  std::vector<bool> joint = promoted_containers(scene, nodes, bone);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const bool hangs = nodes[n].parent >= 0 && joint[nodes[n].parent];
    const bool aid = nodes[n].holds_mesh || nodes[n].is_aid;
    joint[n] = joint[n] || bone[n] || (hangs && (has_bone[n] || !aid));
  }
  return joint;
}

/// Nodes of the joints, hierarchy after hierarchy, the largest first; parent before child.
std::vector<int> by_hierarchy(const std::vector<Node>& nodes, const std::vector<bool>& joint, int& hierarchies) {
  std::vector<int> top(nodes.size(), -1);
  std::map<int, int> size;
  std::vector<int> order;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!joint[n]) continue;
    const int parent = nodes[n].parent;
    top[n] = parent >= 0 && joint[parent] ? top[parent] : static_cast<int>(n);
    ++size[top[n]];
    order.push_back(static_cast<int>(n));
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    if (top[a] == top[b]) return false;
    return size[top[a]] != size[top[b]] ? size[top[a]] > size[top[b]] : top[a] < top[b];
  });
  hierarchies = static_cast<int>(size.size());
  return order;
}

/// Builds the joints one by one; a node that coincides with a joint of its name becomes that joint.
class JointBuilder {
public:
  JointBuilder(std::vector<Node>& nodes, const std::vector<int>& order, double tolerance)
      : nodes_(nodes), tolerance_(tolerance) {
    for (const int n : order) originals_.insert(nodes[n].name);
  }

  void add(int n) {
    Node& node = nodes_[n];
    const int parent = node.parent >= 0 ? nodes_[node.parent].joint : k_no_parent;
    auto& same = by_name_[node.name];
    for (const int joint : same) {
      const bool fits = parent == k_no_parent || parent == joints_.parents[joint];
      if (!fits || !coincide(node, nodes_[joints_.nodes[joint]], tolerance_)) continue;
      node.joint = joint;
      ++shared_;
      return;
    }
    node.joint = static_cast<int>(joints_.names.size());
    joints_.names.push_back(unique_name(node.name));
    if (!same.empty()) renamed_.push_back(joints_.names.back());
    joints_.parents.push_back(parent);
    joints_.nodes.push_back(n);
    joints_.rest.push_back({node.split.rotation, node.global.translation()});
    same.push_back(node.joint);
  }

  Joints take(int hierarchies, ImportReport& report) {
    if (shared_ > 0)
      report.notes.push_back(count_of(hierarchies, "skeleton") + " put in common: " + count_of(shared_, "joint") +
                             " found again under the same name at the same place");
    if (!renamed_.empty())
      report.notes.push_back(
          count_of(renamed_.size(), "joint") +
          " had the name of another joint at a different place, and got a new one: " + list_of(renamed_));
    return std::move(joints_);
  }

private:
  /// Never the name of another node, so that names that are unique in the file stay as they are.
  std::string unique_name(const std::string& original) {
    const std::string base = original.empty() ? "joint" : original;
    std::string name = base;
    for (int i = 2; used_.contains(name) || (name != base && originals_.contains(name)); ++i)
      name = base + "_" + std::to_string(i);
    used_.insert(name);
    return name;
  }

  std::vector<Node>& nodes_;
  double tolerance_;
  std::set<std::string> originals_, used_;
  std::map<std::string, std::vector<int>> by_name_;
  std::vector<std::string> renamed_;
  std::size_t shared_ = 0;
  Joints joints_;
};

} // namespace

Joints choose_joints(const FileScene& scene, std::vector<Node>& nodes, const std::vector<Surface>& surfaces,
                     ImportReport& report) {
  const std::vector<bool> joint = joint_nodes(scene, nodes, surfaces);
  const std::vector<int> order = by_hierarchy(nodes, joint, report.file_skeletons);
  if (order.size() > k_most_joints)
    throw InputError(scene.file, "", count_of(order.size(), "joint"), "at most " + std::to_string(k_most_joints));
  JointBuilder builder(nodes, order, k_same_place * extent(nodes, joint));
  std::vector<std::string> mirrored, stretched;
  for (const int n : order) {
    builder.add(n);
    if (nodes[n].split.stretch.determinant() < 0.0) mirrored.push_back(nodes[n].name);
    if (!is_uniform(nodes[n].split.stretch)) stretched.push_back(nodes[n].name);
  }
  if (!mirrored.empty())
    report.notes.push_back(count_of(mirrored.size(), "joint") +
                           " with mirrored axes, put upright: " + list_of(mirrored));
  if (!stretched.empty())
    report.notes.push_back(count_of(stretched.size(), "joint") +
                           " with scale that differs along its axes: exact at rest, " +
                           "approximate in motion: " + list_of(stretched));
  return builder.take(report.file_skeletons, report);
}

Skeleton build_skeleton(const std::string& file, const Joints& joints, const Conversion& conversion) {
  Skeleton skeleton;
  skeleton.names = joints.names;
  skeleton.parents = joints.parents;
  std::vector<Transform> model;
  for (const Transform& rest : joints.rest) model.push_back(conversion * rest);
  skeleton.rest_local.resize(model.size());
  local_from_model(skeleton, model, skeleton.rest_local);
  for (std::size_t j = 0; j < model.size(); ++j) {
    skeleton.rest_local[j].rotation.normalize();
    if (!is_in_bounds(skeleton.rest_local[j].translation))
      throw InputError(file, "joint " + skeleton.names[j], "a rest position out of all measure",
                       "finite numbers within +-1e9 m");
  }
  skeleton.check(file);
  return skeleton;
}

} // namespace tutu::rig::import_detail
