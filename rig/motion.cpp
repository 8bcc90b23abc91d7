#include "rig/motion.h"

namespace tutu::rig {
namespace {

double start_of(const Clip& clip) { return clip.times.empty() ? 0.0 : clip.times.front(); }
double start_of(const ChannelClip& clip) { return clip.start; }
double duration_of(const Clip& clip) { return clip.times.empty() ? 0.0 : clip.duration(); }
double duration_of(const ChannelClip& clip) { return clip.duration(); }

int joints_of(const Clip& clip) { return clip.joint_count; }
int joints_of(const ChannelClip& clip) { return static_cast<int>(clip.still.size()); }
std::vector<double> keys_of(const Clip& clip) { return clip.times; }
std::vector<double> keys_of(const ChannelClip& clip) { return key_times(clip); }

} // namespace

double Motion::start() const {
  return std::visit([](const auto& clip) { return start_of(clip); }, *this);
}
double Motion::duration() const {
  return std::visit([](const auto& clip) { return duration_of(clip); }, *this);
}

int Motion::joint_count() const {
  return std::visit([](const auto& clip) { return joints_of(clip); }, *this);
}

void sample(const Motion& motion, double time, std::span<Transform> local) {
  std::visit([&](const auto& clip) { sample(clip, time, local); }, motion);
}

void pose_at(const Motion& motion, const Skeleton& skeleton, double time, std::span<Transform> local,
             std::span<Transform> model) {
  sample(motion, motion.start() + time, local);
  model_from_local(skeleton, local, model);
}

std::vector<Transform> first_pose(const Motion& motion) {
  std::vector<Transform> local(static_cast<std::size_t>(motion.joint_count()));
  sample(motion, motion.start(), local);
  return local;
}

std::vector<double> key_times(const Motion& motion) {
  return std::visit([](const auto& clip) { return keys_of(clip); }, motion);
}

void set_interpolation(Motion& motion, const Skeleton& skeleton, Interpolation interpolation) {
  if (const auto* channels = std::get_if<ChannelClip>(&motion)) motion = key_poses(*channels, skeleton);
  set_interpolation(std::get<Clip>(motion), interpolation);
}

} // namespace tutu::rig
