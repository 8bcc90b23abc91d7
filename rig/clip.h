// Motion as key poses, and the pose between two of them.
#pragma once

#include "rig/skeleton.h"

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig {

/// What happens before the first and after the last key.
enum class Extrapolation {
  loop, ///< time wraps; the last key is the first one again (give them the same pose for a smooth loop)
  clamp ///< the first or the last key is held
};

/// The time between `start` and `end` that `time` means on a line that repeats; both ends are themselves. All s.
double wrapped(double time, double start, double end);

/// What lies between two keys.
enum class Interpolation {
  nlerp, ///< translations LERP, rotations nlerp along the shorter arc; velocities jump at keys
  slerp, ///< the same with rotations at constant angular velocity between keys [Shoemake 1985]
  cubic  ///< Hermite curves: velocities continuous at keys, no overshoot (rig/interpolation.h)
};
inline constexpr std::array<std::string_view, 3> k_interpolation_names{"nlerp", "slerp", "cubic"};
/// Of one of k_interpolation_names.
Interpolation interpolation_named(std::string_view name);

/// One joint of one key pose as authored: what is not given is as at rest.
struct JointKey {
  std::optional<Vec3> translation; ///< parent_from_joint, m
  std::optional<Quat> rotation;    ///< parent_from_joint, unit
  bool operator==(const JointKey&) const = default;
};

/// The clip as a person edits it, independent of any skeleton. What runs is a Clip.
struct RawClip {
  struct Key {
    double time = 0.0;                      ///< s
    std::string name;                       ///< for people: "arabesque"; may be empty
    std::map<std::string, JointKey> joints; ///< by joint name
    bool airborne = false;                  ///< the character touches nothing: part of a flight (rig/flight.h)
  };
  std::string file; ///< where it came from, for messages
  std::string name;
  Extrapolation extrapolation = Extrapolation::loop;
  std::vector<Key> keys; ///< strictly rising times
  Interpolation interpolation = Interpolation::nlerp;
};

/// Throws InputError (naming `raw.file` and the key) on no keys, on times that do not strictly rise, on non-finite
/// numbers, on a rotation that is not unit to 1e-6.
void check(const RawClip& raw);

/// Key poses for one skeleton: flat, immutable, dense.
struct Clip {
  std::string name;
  Extrapolation extrapolation = Extrapolation::loop;
  int joint_count = 0;
  std::vector<double> times;    ///< s, strictly rising, at least one
  std::vector<Transform> local; ///< [key * joint_count + joint], parent_from_joint
  std::vector<bool> airborne;   ///< a key; runs of them are flights
  std::vector<int> roots;       ///< joints without a parent: they fly
  Interpolation interpolation = Interpolation::nlerp;
  struct Velocity {
    Vec3 linear, angular; ///< m/s in the parent's frame, rad/s in the joint's own
  };
  std::vector<Velocity> velocities; ///< [key * joint_count + joint] for cubic, else empty

  double duration() const { return times.back() - times.front(); }
  std::span<const Transform> key(int k) const {
    return {local.data() + static_cast<std::size_t>(k) * joint_count, static_cast<std::size_t>(joint_count)};
  }
};

/// Puts a raw clip on a skeleton. Joint names are matched by Skeleton::find. Throws InputError as check() does, on a
/// joint the skeleton lacks, and on two names for one joint in one key. Airborne keys become flights (rig/flight.h),
/// which moves times and roots; throws as make_flights() does.
Clip build_clip(const RawClip& raw, const Skeleton& skeleton);

/// Chooses what lies between the keys of a clip. For `cubic` finds the velocities at all keys by monotone slopes: of a
/// loop across its end, where the last key stands for the first; a clip that clamps begins and ends at rest. A root
/// that takes off or lands has the velocity of its flight, and may dip below the key on the ground to get it.
void set_interpolation(Clip& clip, Interpolation interpolation);

/// The pose at `time` (s) between the two keys around it, by the clip's interpolation; in a flight the roots are on its
/// parabola, whatever the interpolation. Always the same pose for the same time; `local` has joint_count entries.
/// Allocates nothing.
void sample(const Clip& clip, double time, std::span<Transform> local);

/// The pose `time` s after the first key: sample(), then model_from_local(). Both spans have joint_count entries.
void pose_at(const Clip& clip, const Skeleton& skeleton, double time, std::span<Transform> local,
             std::span<Transform> model);

/// A clip made for `source` played by `target`: joints paired by name. For each pair the source's rotation away from
/// its rest pose, seen in model space, is applied to the target's rest pose, whose bone was first turned to point as
/// the source's bone does (so an A-pose can follow a T-pose; joints where pairs branch or end turn with the one above).
/// Joints without a partner keep their rest pose. Translations of the topmost paired joint are scaled by the ratio of
/// its rest heights; other translations are the target's own. Interpolation and flights go along: a flight as high in
/// proportion takes its own time (none where the target's root has no partner). Throws InputError when no joint pairs.
/// `unmatched` (may be null) receives the source joints without a partner.
Clip retarget(const Clip& clip, const Skeleton& source, const Skeleton& target, std::vector<std::string>* unmatched);

} // namespace tutu::rig
