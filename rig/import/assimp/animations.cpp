// Keys as assimp keeps them: times, values, and no law between. They are taken as linear.
#include "rig/error.h"
#include "rig/import/assimp/load.h"
#include "rig/import/detail/parts.h"

#include <assimp/anim.h>
#include <assimp/scene.h>
#include <cmath>
#include <map>

namespace tutu::rig::import_detail {
namespace {

constexpr std::size_t k_most_keys = 20'000'000; ///< of all channels: some gigabytes

Vec3 value_of(const aiVectorKey& key) {
  return {static_cast<double>(key.mValue.x), static_cast<double>(key.mValue.y), static_cast<double>(key.mValue.z)};
}
Eigen::Vector4d value_of(const aiQuatKey& key) {
  return {static_cast<double>(key.mValue.x), static_cast<double>(key.mValue.y), static_cast<double>(key.mValue.z),
          static_cast<double>(key.mValue.w)};
}

/// Keys at rising times: of several at one time the last.
template <typename Key, typename Value>
void add_keys(const Key* keys, unsigned count, double per_second, const std::string& file, const std::string& place,
              Curve<Value>& curve) {
  if (count > 0 && !keys) throw InputError(file, place, "no keys where some are counted", "keys");
  for (unsigned k = 0; k < count; ++k) {
    const double time = keys[k].mTime / per_second;
    const Value value = value_of(keys[k]);
    if (!std::isfinite(time)) throw InputError(file, place, "a non-finite key time", "finite numbers");
    if (!curve.empty() && time < curve.times.back())
      throw InputError(file, place, "key times that fall", "rising key times");
    if (!value.allFinite()) throw InputError(file, place, "a non-finite key", "finite numbers");
    if (!curve.empty() && time == curve.times.back()) {
      curve.values.back() = value;
      continue;
    }
    curve.times.push_back(time);
    curve.values.push_back(value);
    curve.laws.push_back(Law::linear);
  }
}

NodeMotion motion_of(const aiNodeAnim& channel, int node, double per_second, const std::string& file,
                     const std::string& place) {
  NodeMotion motion;
  motion.node = node;
  add_keys(channel.mPositionKeys, channel.mNumPositionKeys, per_second, file, place, motion.translation);
  add_keys(channel.mRotationKeys, channel.mNumRotationKeys, per_second, file, place, motion.rotation);
  add_keys(channel.mScalingKeys, channel.mNumScalingKeys, per_second, file, place, motion.scale);
  for (Eigen::Vector4d& q : motion.rotation.values) {
    if (!(q.norm() >= 1e-6)) throw InputError(file, place, "a rotation that is none", "a unit quaternion");
    q.normalize();
  }
  return motion;
}

} // namespace

std::vector<FileAnimation> animations_of(const aiScene& from, const FileScene& scene, double default_ticks) {
  std::multimap<std::string, int> by_name; // in order
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) by_name.emplace(scene.nodes[n].name, static_cast<int>(n));
  std::vector<FileAnimation> animations;
  std::size_t keys = 0;
  for (unsigned a = 0; a < from.mNumAnimations; ++a) {
    const aiAnimation& source = *from.mAnimations[a];
    FileAnimation& animation = animations.emplace_back();
    animation.name = source.mName.C_Str();
    const std::string place = "animation " + (animation.name.empty() ? std::to_string(a + 1) : animation.name);
    const double per_second = source.mTicksPerSecond == 0.0 ? default_ticks : source.mTicksPerSecond;
    if (!std::isfinite(per_second) || per_second < 0.0)
      throw InputError(scene.file, place, std::to_string(per_second) + " ticks a second", "a positive number");
    std::map<int, NodeMotion> motions;
    std::map<std::string, std::size_t> seen; // the second channel of a name belongs to the second node of that name
    std::size_t nowhere = 0;
    for (unsigned c = 0; c < source.mNumChannels; ++c) {
      const aiNodeAnim& channel = *source.mChannels[c];
      const std::string name = channel.mNodeName.C_Str();
      keys += std::size_t{channel.mNumPositionKeys} + channel.mNumRotationKeys + channel.mNumScalingKeys;
      if (keys > k_most_keys)
        throw InputError(scene.file, place, std::to_string(keys) + " keys", "a shorter animation");
      const auto [begin, end] = by_name.equal_range(name);
      const std::size_t turn = seen[name]++;
      if (turn >= static_cast<std::size_t>(std::distance(begin, end))) {
        ++nowhere;
        continue;
      }
      const int node = std::next(begin, static_cast<std::ptrdiff_t>(turn))->second;
      NodeMotion motion = motion_of(channel, node, per_second, scene.file, place + ", channel " + name);
      for (const auto* times : {&motion.translation.times, &motion.rotation.times, &motion.scale.times})
        if (!times->empty()) {
          animation.start = std::min(animation.start, times->front());
          animation.end = std::max(animation.end, times->back());
        }
      motions.emplace(node, std::move(motion));
    }
    for (auto& [node, motion] : motions) animation.nodes.push_back(std::move(motion));
    if (nowhere > 0) animation.notes.push_back(count_of(nowhere, "channel") + " of nodes that the file has not");
  }
  return animations;
}

} // namespace tutu::rig::import_detail
