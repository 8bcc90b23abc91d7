// Motion as files keep it: each joint's translation and rotation a curve with keys and a law of its own. What is
// imported stays so; what a person edits are key poses (rig/clip.h).
#pragma once

#include "rig/clip.h"
#include "rig/curve.h"

#include <span>
#include <string>
#include <vector>

namespace tutu::rig {

/// For one skeleton; parent_from_joint, m. A curve without keys: as in `still`.
struct ChannelClip {
  struct Joint {
    int joint = 0;
    VectorCurve translation;
    RotationCurve rotation;
  };
  std::string file; ///< where it came from, for messages
  std::string name;
  Extrapolation extrapolation = Extrapolation::loop;
  double start = 0.0, end = 0.0; ///< s: the time line of the file; start <= end
  std::vector<Transform> still;  ///< [joint]: the pose of what does not move, which need not be the rest pose
  std::vector<Joint> joints;     ///< rising joints

  double duration() const { return end - start; }
};

/// Throws InputError (naming `clip.file`) on curves as check() of a curve does, on joints that `still` has not or that
/// do not rise, on a time line that ends before it starts.
void check(const ChannelClip& clip);

/// The pose at `time` (s, on the clip's time line); beyond it as the extrapolation says. `local` has as many entries
/// as `still`. Allocates nothing.
void sample(const ChannelClip& clip, double time, std::span<Transform> local);

/// All different times of keys inside the time line, its start and its end among them; s, rising.
std::vector<double> key_times(const ChannelClip& clip);

/// The poses at all key times as key poses, for who asks for another law between keys than the file's.
Clip key_poses(const ChannelClip& clip, const Skeleton& skeleton);

} // namespace tutu::rig
