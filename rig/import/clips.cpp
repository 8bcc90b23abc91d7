// Animations of the file as key poses on our joints.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <algorithm>
#include <assimp/anim.h>
#include <assimp/scene.h>
#include <cmath>
#include <map>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_default_ticks = 25.0; ///< a second, when the file does not say
constexpr double k_same_time = 1e-9;     ///< s
constexpr double k_rest_tolerance =
    1e-4; ///< of the entries' size: a channel nearer than this to the rest transform does not move
constexpr std::size_t k_most_key_joints = 20'000'000; ///< keys times joints of a clip: some gigabytes

Vec3 vector_of(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Quat quaternion_of(const aiQuaternion& q) {
  return {static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z)};
}

/// The two keys around a time and the share of the second. Keys rise in time.
template <typename Key> struct Around {
  const Key *before, *after;
  double share;
};
template <typename Key> Around<Key> around(const Key* keys, unsigned count, double tick) {
  const Key* after = std::upper_bound(keys, keys + count, tick, [](double t, const Key& key) { return t < key.mTime; });
  if (after == keys) return {keys, keys, 0.0};
  const Key* before = after - 1;
  if (after == keys + count || !(after->mTime > before->mTime)) return {before, before, 0.0};
  return {before, after, (tick - before->mTime) / (after->mTime - before->mTime)};
}

Vec3 vector_at(const aiVectorKey* keys, unsigned count, double tick) {
  const auto [before, after, share] = around(keys, count, tick);
  return vector_of(before->mValue) + share * (vector_of(after->mValue) - vector_of(before->mValue));
}
Quat rotation_at(const aiQuatKey* keys, unsigned count, double tick) {
  const auto [before, after, share] = around(keys, count, tick);
  return quaternion_of(before->mValue).normalized().slerp(share, quaternion_of(after->mValue).normalized());
}

template <typename Key>
void check_keys(const Key* keys, unsigned count, const std::string& file, const std::string& place) {
  if (count > 0 && !keys) throw InputError(file, place, "no keys where some are counted", "keys");
  for (unsigned k = 0; k < count; ++k) {
    if (!std::isfinite(keys[k].mTime)) throw InputError(file, place, "a non-finite key time", "finite numbers");
    if (k > 0 && keys[k].mTime < keys[k - 1].mTime)
      throw InputError(file, place, "key times that fall", "rising key times");
  }
}
void check_channel(const aiNodeAnim& channel, const std::string& file, const std::string& place) {
  check_keys(channel.mPositionKeys, channel.mNumPositionKeys, file, place);
  check_keys(channel.mRotationKeys, channel.mNumRotationKeys, file, place);
  check_keys(channel.mScalingKeys, channel.mNumScalingKeys, file, place);
  for (unsigned k = 0; k < channel.mNumPositionKeys; ++k)
    if (!vector_of(channel.mPositionKeys[k].mValue).allFinite())
      throw InputError(file, place, "a non-finite translation", "finite numbers");
  for (unsigned k = 0; k < channel.mNumRotationKeys; ++k) {
    const double norm = quaternion_of(channel.mRotationKeys[k].mValue).norm();
    if (!std::isfinite(norm) || norm < 1e-6)
      throw InputError(file, place, "a rotation that is none", "a unit quaternion");
  }
}

bool scale_changes(const aiNodeAnim& channel, const Node& node) {
  const Vec3 rest = node.local.linear().colwise().norm();
  for (unsigned k = 0; k < channel.mNumScalingKeys; ++k)
    if (((vector_of(channel.mScalingKeys[k].mValue).cwiseAbs() - rest).cwiseAbs().array() > 1e-3 * rest.maxCoeff())
            .any())
      return true;
  return false;
}

/// One joint's channel, and how to convert what it says.
class Track {
public:
  Track(const aiNodeAnim& channel, const std::vector<Node>& nodes, int node, const Conversion& conversion)
      : channel_(channel), scale_(conversion.scale) {
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
    turn_ = conversion.rotation * parent.split.rotation; // a root joint: the containers above it are part of its rest
    offset_ = conversion.rotation * (conversion.scale * parent.global.translation());
  }

  /// parent_from_joint at a time, rigid, m.
  JointKey at(double tick) const {
    JointKey key;
    if (channel_.mNumPositionKeys > 0) {
      const Vec3 translation = vector_at(channel_.mPositionKeys, channel_.mNumPositionKeys, tick);
      key.translation = offset_ + turn_ * (scale_ * (parent_stretch_ * translation));
    }
    if (channel_.mNumRotationKeys > 0) {
      const Quat rotation = rotation_at(channel_.mRotationKeys, channel_.mNumRotationKeys, tick);
      const Quat local =
          plain_ ? rotation : polar(parent_stretch_ * rotation.toRotationMatrix() * own_stretch_).rotation;
      key.rotation = (turn_ * local).normalized();
    }
    return key;
  }

  void collect_ticks(std::vector<double>& ticks) const {
    for (unsigned k = 0; k < channel_.mNumPositionKeys; ++k) ticks.push_back(channel_.mPositionKeys[k].mTime);
    for (unsigned k = 0; k < channel_.mNumRotationKeys; ++k) ticks.push_back(channel_.mRotationKeys[k].mTime);
  }

private:
  const aiNodeAnim& channel_;
  double scale_;
  Matrix3 parent_stretch_ = Matrix3::Identity(), own_stretch_ = Matrix3::Identity();
  Quat turn_ = Quat::Identity();
  Vec3 offset_ = Vec3::Zero();
  bool plain_ = true; ///< the parent's scale is uniform: rotations are taken as they are
};

struct TrackList {
  std::vector<std::pair<int, Track>> tracks; ///< joint, track
  std::vector<std::string> scaled;
  std::size_t foreign = 0; ///< channels on nodes that are no joint
};

/// The channels on joints. assimp names nodes only, so the second channel of a name belongs to the second joint of that
/// name.
TrackList tracks_of(const Source& source, const aiAnimation& animation, const std::vector<Node>& nodes,
                    const Joints& joints, const Conversion& conversion, const std::string& place) {
  std::multimap<std::string, int> by_name; // joints in order
  for (std::size_t j = 0; j < joints.nodes.size(); ++j)
    by_name.emplace(nodes[joints.nodes[j]].name, static_cast<int>(j));
  std::map<std::string, std::size_t> seen;
  TrackList list;
  for (unsigned c = 0; c < animation.mNumChannels; ++c) {
    const aiNodeAnim& channel = *animation.mChannels[c];
    const std::string name = channel.mNodeName.C_Str();
    check_channel(channel, source.file, place + ", channel " + name);
    const auto [begin, end] = by_name.equal_range(name);
    const std::size_t turn = seen[name]++;
    if (begin == end) ++list.foreign;
    if (turn >= static_cast<std::size_t>(std::distance(begin, end))) continue;
    const int joint = std::next(begin, static_cast<std::ptrdiff_t>(turn))->second;
    const int node = joints.nodes[joint];
    if (scale_changes(channel, nodes[node])) list.scaled.push_back(joints.names[joint]);
    list.tracks.emplace_back(joint, Track(channel, nodes, node, conversion));
  }
  return list;
}

} // namespace

bool is_moved(const Source& source, const Node& node) {
  const double turn = 2.0 * k_rest_tolerance; // rad
  const Quat rest = polar(node.local.linear()).rotation;
  const Vec3 stands = node.local.translation();
  for (unsigned a = 0; a < source.scene->mNumAnimations; ++a)
    for (unsigned c = 0; c < source.scene->mAnimations[a]->mNumChannels; ++c) {
      const aiNodeAnim& channel = *source.scene->mAnimations[a]->mChannels[c];
      if (node.name != channel.mNodeName.C_Str()) continue;
      for (unsigned k = 0; k < channel.mNumPositionKeys; ++k)
        if (!((vector_of(channel.mPositionKeys[k].mValue) - stands).norm() <=
              k_rest_tolerance * std::max(1.0, stands.norm())))
          return true;
      for (unsigned k = 0; k < channel.mNumRotationKeys; ++k)
        if (!(quaternion_of(channel.mRotationKeys[k].mValue).normalized().angularDistance(rest) <= turn)) return true;
    }
  return false;
}

std::vector<RawClip> build_clips(const Source& source, const std::vector<Node>& nodes, const Joints& joints,
                                 const Conversion& conversion, ImportReport& report) {
  std::vector<RawClip> clips;
  for (unsigned a = 0; a < source.scene->mNumAnimations; ++a) {
    const aiAnimation& animation = *source.scene->mAnimations[a];
    RawClip clip;
    clip.file = source.file;
    clip.name = animation.mName.length > 0 ? animation.mName.C_Str() : "clip " + std::to_string(a + 1);
    const std::string place = "animation " + clip.name;
    const TrackList list = tracks_of(source, animation, nodes, joints, conversion, place);

    const double per_second = animation.mTicksPerSecond == 0.0 ? k_default_ticks : animation.mTicksPerSecond;
    if (!std::isfinite(per_second) || per_second < 0.0)
      throw InputError(source.file, place, std::to_string(per_second) + " ticks a second", "a positive number");
    std::vector<double> ticks;
    for (const auto& [joint, track] : list.tracks) track.collect_ticks(ticks);
    std::sort(ticks.begin(), ticks.end());
    ticks.erase(std::unique(ticks.begin(), ticks.end(),
                            [&](double before, double after) { return after - before <= k_same_time * per_second; }),
                ticks.end());
    if (ticks.empty()) {
      report.notes.push_back(place + " moves no joint: left out");
      continue;
    }
    if (ticks.size() * list.tracks.size() > k_most_key_joints)
      throw InputError(source.file, place,
                       count_of(ticks.size(), "key") + " of " + count_of(list.tracks.size(), "joint"),
                       "a shorter animation");
    for (const double tick : ticks) {
      RawClip::Key key;
      key.time = tick / per_second;
      for (const auto& [joint, track] : list.tracks)
        key.joints.emplace_hint(key.joints.end(), joints.names[joint], track.at(tick));
      clip.keys.push_back(std::move(key));
    }
    if (!list.scaled.empty())
      report.notes.push_back(place + ": changing scale of " + count_of(list.scaled.size(), "joint") +
                             " ignored: " + list_of(list.scaled));
    if (list.foreign > 0)
      report.notes.push_back(place + ": " + count_of(list.foreign, "channel") + " on nodes that are no joint left out");
    clips.push_back(std::move(clip));
  }
  return clips;
}

} // namespace tutu::rig::import_detail
