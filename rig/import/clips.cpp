// Animations of the file as channels of our joints.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tutu::rig::import_detail {
namespace {

using Vec4 = Eigen::Vector4d;

constexpr double k_rest_tolerance =
    1e-4; ///< of the entries' size: a channel nearer than this to where the node stands does not move it

bool scale_changes(const VectorCurve& scale, const Node& node) {
  const Vec3 rest = node.local.linear().colwise().norm();
  return std::any_of(scale.values.begin(), scale.values.end(), [&](const Vec3& key) {
    return ((key.cwiseAbs() - rest).cwiseAbs().array() > 1e-3 * rest.maxCoeff()).any();
  });
}

/// A curve whose values, and with them its tangents, went through a linear map.
template <typename Value, typename Map> Curve<Value> mapped(Curve<Value> curve, const Map& map) {
  for (auto* values : {&curve.values, &curve.leaving, &curve.arriving})
    for (Value& value : *values) value = map(value);
  return curve;
}

/// How to convert what a node's channels say to parent_from_joint, rigid, m.
class Converter {
public:
  Converter(const std::vector<Node>& nodes, int node, const Conversion& conversion) : scale_(conversion.scale) {
    const Node& own = nodes[node];
    own_stretch_ = polar(own.local.linear()).stretch;
    if (own.parent < 0) {
      turn_ = conversion.rotation;
      return;
    }
    const Node& parent = nodes[own.parent];
    parent_stretch_ = parent.split.stretch;
    plain_ = is_uniform(parent_stretch_);
    if (parent.joint >= 0) return;
    turn_ = conversion.rotation * parent.split.rotation; // a root joint: the containers above it are part of its place
    offset_ = conversion.rotation * (conversion.scale * parent.global.translation());
  }

  VectorCurve translation(const VectorCurve& curve) const {
    VectorCurve result = mapped(curve, [&](const Vec3& v) { return Vec3(turn_ * (scale_ * (parent_stretch_ * v))); });
    for (Vec3& value : result.values) value += offset_;
    return result;
  }

  RotationCurve rotation(const RotationCurve& curve) const {
    if (plain_) return mapped(curve, [&](const Vec4& q) { return Vec4((turn_ * Quat(q)).coeffs()); });
    return sampled(curve);
  }

private:
  /// Below a scale that differs along its axes no law stays what it is: straight pieces, short ones.
  RotationCurve sampled(const RotationCurve& curve) const {
    constexpr double k_piece = 1.0 / 120.0;  // s
    constexpr double k_most_pieces = 1000.0; // of one stretch between keys
    RotationCurve result;
    const auto add = [&](double time, const Quat& rotation, Law law) {
      const Quat local = polar(parent_stretch_ * rotation.toRotationMatrix() * own_stretch_).rotation;
      result.times.push_back(time);
      result.values.push_back((turn_ * local).normalized().coeffs());
      result.laws.push_back(law);
    };
    for (std::size_t k = 0; k < curve.times.size(); ++k) {
      const Law law = curve.laws[k] == Law::step ? Law::step : Law::linear;
      add(curve.times[k], Quat(curve.values[k]), law);
      if (k + 1 == curve.times.size() || law == Law::step) continue;
      const double span = curve.times[k + 1] - curve.times[k];
      const auto pieces = static_cast<int>(std::clamp(std::ceil(span / k_piece), 1.0, k_most_pieces));
      for (int p = 1; p < pieces; ++p) {
        const double time = curve.times[k] + span * p / pieces;
        add(time, value_at(curve, time), law);
      }
    }
    return result;
  }

  double scale_;
  Matrix3 parent_stretch_ = Matrix3::Identity(), own_stretch_ = Matrix3::Identity();
  Quat turn_ = Quat::Identity();
  Vec3 offset_ = Vec3::Zero();
  bool plain_ = true; ///< the parent's scale is uniform: rotations are taken as they are
};

/// The joints' places as the nodes stand: parent_from_joint.
std::vector<Transform> still_pose(const std::vector<Node>& nodes, const Joints& joints, const Conversion& conversion) {
  std::vector<Transform> model;
  for (const int n : joints.nodes)
    model.push_back(conversion * Transform{nodes[n].split.rotation, nodes[n].global.translation()});
  std::vector<Transform> local(model.size());
  Skeleton skeleton;
  skeleton.names = joints.names;
  skeleton.parents = joints.parents;
  local_from_model(skeleton, model, local);
  for (Transform& transform : local) transform.rotation.normalize();
  return local;
}

/// Channels by joint. Where two nodes are one joint, those of the node the joint follows count.
std::map<int, const NodeMotion*> motion_of_joints(const FileAnimation& animation, const std::vector<Node>& nodes,
                                                  const Joints& joints) {
  std::map<int, const NodeMotion*> found;
  for (const NodeMotion& motion : animation.nodes) {
    const int joint = nodes[motion.node].joint;
    if (joint < 0) continue;
    if (joints.nodes[joint] == motion.node) found[joint] = &motion;
    else found.try_emplace(joint, &motion);
  }
  return found;
}

} // namespace

bool is_moved(const FileScene& scene, const std::vector<Node>& nodes, int node) {
  const double turn = 2.0 * k_rest_tolerance; // rad
  const Quat rest = polar(nodes[node].local.linear()).rotation;
  const Vec3 stands = nodes[node].local.translation();
  const auto moves = [&](const Vec3& v) {
    return !((v - stands).norm() <= k_rest_tolerance * std::max(1.0, stands.norm()));
  };
  const auto turns = [&](const Vec4& q) { return !(Quat(q).angularDistance(rest) <= turn); };
  for (const FileAnimation& animation : scene.animations)
    for (const NodeMotion& motion : animation.nodes)
      if (motion.node == node &&
          (std::ranges::any_of(motion.translation.values, moves) || std::ranges::any_of(motion.rotation.values, turns)))
        return true;
  return false;
}

std::vector<ChannelClip> build_clips(const FileScene& scene, const std::vector<Node>& nodes, const Joints& joints,
                                     const Conversion& conversion, ImportReport& report) {
  const std::vector<Transform> still = still_pose(nodes, joints, conversion);
  std::vector<ChannelClip> clips;
  for (std::size_t a = 0; a < scene.animations.size(); ++a) {
    const FileAnimation& animation = scene.animations[a];
    ChannelClip clip;
    clip.file = scene.file;
    clip.name = animation.name.empty() ? "clip " + std::to_string(a + 1) : animation.name;
    clip.start = animation.start;
    clip.end = animation.end;
    clip.still = still;
    const std::string place = "animation " + clip.name;
    for (const std::string& note : animation.notes) report.notes.push_back(place + ": " + note);

    std::size_t foreign = 0;
    for (const NodeMotion& motion : animation.nodes)
      if (nodes[motion.node].joint < 0) ++foreign;
    std::vector<std::string> scaled;
    for (const auto& [joint, motion] : motion_of_joints(animation, nodes, joints)) {
      const Converter converter(nodes, motion->node, conversion);
      if (scale_changes(motion->scale, nodes[motion->node])) scaled.push_back(joints.names[joint]);
      ChannelClip::Joint channels{joint, converter.translation(motion->translation),
                                  converter.rotation(motion->rotation)};
      if (!channels.translation.empty() || !channels.rotation.empty()) clip.joints.push_back(std::move(channels));
    }
    if (clip.joints.empty()) {
      report.notes.push_back(place + " moves no joint: left out");
      continue;
    }
    if (!scaled.empty())
      report.notes.push_back(place + ": changing scale of " + count_of(scaled.size(), "joint") +
                             " ignored: " + list_of(scaled));
    if (foreign > 0)
      report.notes.push_back(place + ": channels of " + count_of(foreign, "node") + " that " +
                             (foreign == 1 ? "is no joint" : "are no joints") + " left out");
    clips.push_back(std::move(clip));
  }
  return clips;
}

} // namespace tutu::rig::import_detail
