// Where the joints rest: in the pose the skin was bound in, which the inverse bind matrices hold.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_same_place = 1e-4;    ///< of the skeleton's size: a joint nearer than this stands where it was bound
constexpr double k_same_rotation = 1e-3; ///< rad
/// Bones of the bind pose may differ this much from those of the nodes, in the middle: a pose turns bones, it does not
/// stretch them.
constexpr double k_same_length = 0.1;

/// bind space_from_joint of the joints that a skin names: of several skins, of the one with the most influences.
class BoundJoints {
public:
  BoundJoints(const std::vector<Node>& nodes, const Joints& joints, const std::vector<Surface>& surfaces)
      : nodes_(nodes), joints_(joints) {
    std::vector<const Surface*> by_size;
    for (const Surface& surface : surfaces) by_size.push_back(&surface);
    std::ranges::stable_sort(by_size, std::greater(), [](const Surface* s) { return s->influences.size(); });
    for (const Surface* surface : by_size) add(*surface);
  }

  /// file_from_joint of each joint; none where no skin says it.
  const std::vector<std::optional<Affine>>& places() const { return places_; }
  /// Meshes bound to bones of another length than the nodes have.
  const std::vector<std::string>& unlike() const { return unlike_; }

private:
  void add(const Surface& surface) {
    std::map<int, Affine> bound; // joint: vertex_from_joint
    for (const Binding& binding : surface.bindings) {
      const Affine place = binding.inverse_bind.inverse();
      if (place.matrix().allFinite()) bound.try_emplace(nodes_[binding.node].joint, place);
    }
    const std::optional<Affine> file_from_vertex = space_of(surface, bound);
    if (!file_from_vertex) unlike_.push_back(surface.mesh->name);
    else
      for (const auto& [joint, place] : bound)
        if (!places_[joint]) places_[joint] = *file_from_vertex * place;
  }

  /// The space the skin was bound in, as seen from the file: no format says which, so of the root, the mesh's node and
  /// what is above the joints that one which puts the joints nearest to where their nodes stand. None where the bones
  /// are of another length in all of them.
  std::optional<Affine> space_of(const Surface& surface, const std::map<int, Affine>& bound) const {
    std::vector<Affine> spaces = {Affine::Identity(), nodes_[0].global};
    const auto add_line = [&](int node) {
      for (; node >= 0; node = nodes_[node].parent)
        if (nodes_[node].joint < 0) spaces.push_back(nodes_[node].global);
    };
    add_line(surface.holder);
    if (!bound.empty()) add_line(nodes_[joints_.nodes[bound.begin()->first]].parent);
    for (Affine& space : spaces) space = space * surface.bind_shape;
    if (const auto best = nearest(spaces, bound); best || bound.empty()) return best;
    const Matrix3 measure = measure_of(surface, bound);
    for (Affine& space : spaces) {
      space.linear() = polar(space.linear()).rotation * measure;
      space.translation() = Vec3::Zero();
      Vec3 away = Vec3::Zero(); // nothing tells the place: on the whole where the nodes stand
      for (const auto& [joint, place] : bound) away += stands(joint) - space * place.translation();
      space.translation() = away / static_cast<double>(bound.size());
    }
    return nearest(spaces, bound);
  }

  Vec3 stands(int joint) const { return nodes_[joints_.nodes[joint]].global.translation(); }

  std::optional<Affine> nearest(const std::vector<Affine>& spaces, const std::map<int, Affine>& bound) const {
    std::optional<Affine> best;
    double least = std::numeric_limits<double>::infinity();
    for (const Affine& space : spaces) {
      double off = 0.0;
      for (const auto& [joint, place] : bound) off += (space * place.translation() - stands(joint)).norm();
      if (!(off < (1.0 - 1e-6) * least) || !has_same_bones(space, bound)) continue;
      least = off;
      best = space;
    }
    return best;
  }

  /// Vertices may be in a measure of their own along each axis (quantised, say), which the inverse binds undo: what the
  /// main joint's has beyond a rotation and the node's scale.
  Matrix3 measure_of(const Surface& surface, const std::map<int, Affine>& bound) const {
    const Node& node = nodes_[surface.bindings[surface.dominant].node];
    const auto main = bound.find(node.joint);
    if (main == bound.end()) return Matrix3::Identity();
    const double scale = std::cbrt(std::abs(node.split.stretch.determinant()));
    const Matrix3 turned_first = main->second.linear().transpose();
    return scale * polar(turned_first).stretch.inverse();
  }

  bool has_same_bones(const Affine& space, const std::map<int, Affine>& bound) const {
    std::vector<double> ratios;
    for (const auto& [joint, place] : bound) {
      const auto parent = bound.find(joints_.parents[joint]);
      if (parent == bound.end()) continue;
      const double length = (stands(joint) - stands(parent->first)).norm();
      if (length > 0.0)
        ratios.push_back((space * place.translation() - space * parent->second.translation()).norm() / length);
    }
    if (ratios.empty()) return true;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return std::abs(*middle - 1.0) <= k_same_length;
  }

  const std::vector<Node>& nodes_;
  const Joints& joints_;
  std::vector<std::optional<Affine>> places_{joints_.names.size()};
  std::vector<std::string> unlike_;
};

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

} // namespace

void rest_in_bind_pose(const std::vector<Node>& nodes, const std::vector<Surface>& surfaces, Joints& joints,
                       ImportReport& report) {
  const BoundJoints bound(nodes, joints, surfaces);
  if (!bound.unlike().empty())
    report.notes.push_back(
        count_of(bound.unlike().size(), "mesh") +
        " bound to bones that are not as long as the nodes' say nothing of a bind pose: " + list_of(bound.unlike()));
  Eigen::AlignedBox3d box;
  for (const Transform& rest : joints.rest) box.extend(rest.translation);
  const double size = box.diagonal().norm();

  // Without a skin of its own a joint stays with the one above it.
  std::vector<Affine> place;
  std::size_t moved = 0;
  double farthest = 0.0;
  for (std::size_t j = 0; j < joints.rest.size(); ++j) {
    const Node& node = nodes[joints.nodes[j]];
    const int parent = joints.parents[j];
    if (const auto& own = bound.places()[j]) place.push_back(*own);
    else if (parent == k_no_parent) place.push_back(node.global);
    else place.push_back(place[parent] * nodes[joints.nodes[parent]].global.inverse() * node.global);
    if (!place.back().matrix().allFinite()) place.back() = node.global; // below a joint of no extent
    const double away = (place.back().translation() - node.global.translation()).norm();
    const double turned = polar(place.back().linear()).rotation.angularDistance(node.split.rotation);
    if (away <= k_same_place * size && turned <= k_same_rotation) continue;
    ++moved;
    farthest = std::max(farthest, away);
  }
  if (moved == 0) return; // to the last digit as the nodes stand
  for (std::size_t j = 0; j < joints.rest.size(); ++j)
    joints.rest[j] = {polar(place[j].linear()).rotation, place[j].translation()};
  report.notes.push_back("rests in its bind pose; the file's nodes stand in another one (" + std::to_string(moved) +
                         " of " + std::to_string(joints.rest.size()) + " joints differ, by up to " +
                         shown(size > 0.0 ? 100.0 * farthest / size : 0.0) + " % of the skeleton's size)");
}

Affine carried_at_rest(const std::vector<Node>& nodes, const Joints& joints, const Binding& binding) {
  const Node& node = nodes[binding.node];
  const Transform& rest = joints.rest[node.joint];
  Affine result = Affine::Identity();
  result.linear() = rest.rotation.toRotationMatrix() * node.split.stretch;
  result.translation() = rest.translation;
  return result * binding.inverse_bind;
}

} // namespace tutu::rig::import_detail
