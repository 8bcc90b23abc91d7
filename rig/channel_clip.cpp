#include "rig/channel_clip.h"

#include "rig/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tutu::rig {

void check(const ChannelClip& clip) {
  const std::string place = "clip " + clip.name;
  if (!(std::abs(clip.start) <= k_largest_number && std::abs(clip.end) <= k_largest_number && clip.start <= clip.end))
    throw InputError(clip.file, place, "a time line that ends before it starts", "one that goes on");
  int last = -1;
  for (const ChannelClip::Joint& joint : clip.joints) {
    if (joint.joint <= last || joint.joint >= static_cast<int>(clip.still.size()))
      throw InputError(clip.file, place, "channels of joint " + std::to_string(joint.joint), "each joint once");
    last = joint.joint;
    check(joint.translation, clip.file, place);
    check(joint.rotation, clip.file, place);
  }
}

void sample(const ChannelClip& clip, double time, std::span<Transform> local) {
  assert(local.size() == clip.still.size());
  const double t = clip.extrapolation == Extrapolation::loop ? wrapped(time, clip.start, clip.end)
                                                             : std::clamp(time, clip.start, clip.end);
  std::ranges::copy(clip.still, local.begin());
  for (const ChannelClip::Joint& joint : clip.joints) {
    if (!joint.translation.empty()) local[joint.joint].translation = value_at(joint.translation, t);
    if (!joint.rotation.empty()) local[joint.joint].rotation = value_at(joint.rotation, t);
  }
}

std::vector<double> key_times(const ChannelClip& clip) {
  std::vector<double> times = {clip.start, clip.end};
  const auto add = [&](const std::vector<double>& keys) {
    std::ranges::copy_if(keys, std::back_inserter(times), [&](double t) { return t > clip.start && t < clip.end; });
  };
  for (const ChannelClip::Joint& joint : clip.joints) {
    add(joint.translation.times);
    add(joint.rotation.times);
  }
  std::ranges::sort(times);
  constexpr double k_same_time = 1e-9; // s: one key, written by two channels in single precision of the same frame
  times.erase(std::unique(times.begin(), times.end(), [](double a, double b) { return b - a <= k_same_time; }),
              times.end());
  return times;
}

Clip key_poses(const ChannelClip& clip, const Skeleton& skeleton) {
  Clip result;
  result.name = clip.name;
  result.extrapolation = clip.extrapolation;
  result.joint_count = skeleton.joint_count();
  result.times = key_times(clip);
  result.local.resize(result.times.size() * clip.still.size());
  for (std::size_t k = 0; k < result.times.size(); ++k) // both ends of what loops are themselves
    sample(clip, result.times[k], {result.local.data() + k * clip.still.size(), clip.still.size()});
  result.airborne.assign(result.times.size(), false);
  result.roots = roots_of(skeleton);
  return result;
}

} // namespace tutu::rig
