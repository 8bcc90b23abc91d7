// What a character plays, whichever way it was made.
#pragma once

#include "rig/channel_clip.h"
#include "rig/clip.h"

#include <span>
#include <variant>
#include <vector>

namespace tutu::rig {

/// Key poses, or channels as a file keeps them.
struct Motion : std::variant<Clip, ChannelClip> {
  using variant::variant;

  double start() const;    ///< s, of the first pose
  double duration() const; ///< s
  int joint_count() const;
};

/// The pose at `time` (s, on the motion's own time line); beyond it as its extrapolation says. Allocates nothing.
void sample(const Motion& motion, double time, std::span<Transform> local);

/// The pose `time` s after the motion's start: sample(), then model_from_local(). Both spans have joint_count entries.
void pose_at(const Motion& motion, const Skeleton& skeleton, double time, std::span<Transform> local,
             std::span<Transform> model);

std::vector<Transform> first_pose(const Motion& motion);

/// Of all keys, start and end among them; s, rising.
std::vector<double> key_times(const Motion& motion);

/// Chooses what lies between keys: of channels, that makes key poses of them.
void set_interpolation(Motion& motion, const Skeleton& skeleton, Interpolation interpolation);

} // namespace tutu::rig
