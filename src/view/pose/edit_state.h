// What the pose editor edits, as plain values: the pose in hand and the keys of the clip. The history keeps many.
#pragma once

#include "rig/clip.h"
#include "rig/ik.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::app {

using Pose = std::vector<Transform>; ///< parent_from_joint of every joint of a skeleton

struct EditKey {
  double time = 0.0; ///< s
  std::string name;
  bool airborne = false;
  std::shared_ptr<const Pose> pose; ///< immutable, shared by all states of the history that hold this key
};

struct EditState {
  Pose pose;                      ///< in hand
  bool loose = false;             ///< the pose has been edited since it came out of a key or went into one
  double time = 0.0;              ///< s, the playhead
  std::vector<EditKey> keys;      ///< strictly rising times; may be none
  std::vector<rig::FootPin> pins; ///< feet that stay where they are while something else is dragged
  std::string name;               ///< of the clip
  rig::Extrapolation extrapolation = rig::Extrapolation::loop;
  rig::Interpolation interpolation = rig::Interpolation::nlerp;
};

/// To the bit.
bool same_pose(std::span<const Transform> a, std::span<const Transform> b);
/// Would both be written as the same clip?
bool same_clip(const EditState& a, const EditState& b);

/// The keys of a clip, the first of them in hand. Throws InputError as build_clip() does (flights are not looked at).
EditState edit_state(const rig::RawClip& raw, const rig::Skeleton& skeleton);
/// No keys, and the rest pose in hand.
EditState edit_state_at_rest(const rig::Skeleton& skeleton, std::string name);
/// As it is written: what is as at rest is left out.
rig::RawClip raw_clip(const EditState& state, const rig::Skeleton& skeleton);

/// The key at `time`, to half a millisecond.
std::optional<int> key_at(const EditState& state, double time);
/// A loop whose last key is its first pose again.
bool is_closed(const EditState& state);

/// Moves the playhead within the keys and takes the pose there in hand; pins are let go. Nothing without keys. With
/// jumps that cannot be (rig/flight.h) the root goes as on the ground.
void seek(EditState& state, const rig::Skeleton& skeleton, double time);

/// The pose in hand becomes the next key, `interval` s (> 0) after the last. In a closed loop it takes the place of the
/// closing key, which moves on by `interval`.
void add_next_key(EditState& state, double interval);
/// The pose in hand becomes the key at the playhead: that key's pose, or a new key.
void set_key_here(EditState& state);
/// A loop of two or more keys gets its first pose as another key, `interval` s after the last, unless it has it.
void close_loop(EditState& state, double interval);
void delete_key(EditState& state, int key);
/// The copy stands half way to the next key, behind the last one `interval` s later. Returns its index.
int duplicate_key(EditState& state, int key, double interval);
/// Puts the key at another time, past others if need be, a millisecond at least from each. Returns its index then.
int move_key(EditState& state, int key, double time);
/// Puts the key at another time, behind the one before it, and all later keys along with it.
void retime_from(EditState& state, int key, double time);

} // namespace tutu::app
