#include "src/view/pose/edit_state.h"

#include "rig/error.h"
#include "rig/flight.h"

#include <algorithm>
#include <cmath>

namespace tutu::app {
namespace {

constexpr double k_same_time = 5e-4; // s; far below a frame
constexpr double k_least_gap = 1e-3; // s between keys; larger than k_same_time, so that each can be hit

rig::Clip clip_of(const EditState& state, const rig::Skeleton& skeleton, bool flights) {
  rig::Clip clip;
  clip.extrapolation = state.extrapolation;
  clip.joint_count = skeleton.joint_count();
  for (const EditKey& key : state.keys) {
    clip.times.push_back(key.time);
    clip.local.insert(clip.local.end(), key.pose->begin(), key.pose->end());
    clip.airborne.push_back(flights && key.airborne);
  }
  clip.roots = rig::roots_of(skeleton);
  rig::make_flights(clip, state.name);
  rig::set_interpolation(clip, state.interpolation);
  return clip;
}

rig::Clip playable_clip(const EditState& state, const rig::Skeleton& skeleton) {
  try {
    return clip_of(state, skeleton, true);
  } catch (const InputError&) { // a jump in the making
    return clip_of(state, skeleton, false);
  }
}

bool rises(const EditKey& a, const EditKey& b) { return a.time < b.time; }

/// The time nearest to `time` that is a gap away from all keys but `skipped`.
double free_time(const std::vector<EditKey>& keys, int skipped, double time) {
  const auto is_free = [&](double t) {
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (static_cast<int>(k) != skipped && std::abs(keys[k].time - t) < k_least_gap * (1.0 - 1e-6)) return false;
    return true;
  };
  for (int n = 0;; ++n)
    for (const double t : {time - n * k_least_gap, time + n * k_least_gap})
      if (is_free(t)) return t;
}

} // namespace

bool same_pose(std::span<const Transform> a, std::span<const Transform> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Transform& x, const Transform& y) {
    return x.rotation.coeffs() == y.rotation.coeffs() && x.translation == y.translation;
  });
}

bool same_clip(const EditState& a, const EditState& b) {
  return a.name == b.name && a.extrapolation == b.extrapolation && a.interpolation == b.interpolation &&
         std::equal(a.keys.begin(), a.keys.end(), b.keys.begin(), b.keys.end(), [](const EditKey& x, const EditKey& y) {
           return x.time == y.time && x.name == y.name && x.airborne == y.airborne &&
                  (x.pose == y.pose || same_pose(*x.pose, *y.pose));
         });
}

EditState edit_state(const rig::RawClip& raw, const rig::Skeleton& skeleton) {
  rig::RawClip on_ground = raw;
  for (rig::RawClip::Key& key : on_ground.keys) key.airborne = false;
  const rig::Clip clip = rig::build_clip(on_ground, skeleton);
  EditState state;
  state.name = raw.name;
  state.extrapolation = raw.extrapolation;
  state.interpolation = raw.interpolation;
  for (std::size_t k = 0; k < raw.keys.size(); ++k) {
    const auto pose = clip.key(static_cast<int>(k));
    state.keys.push_back({raw.keys[k].time, raw.keys[k].name, raw.keys[k].airborne,
                          std::make_shared<const Pose>(pose.begin(), pose.end())});
  }
  state.pose = *state.keys.front().pose;
  state.time = state.keys.front().time;
  return state;
}

EditState edit_state_at_rest(const rig::Skeleton& skeleton, std::string name) {
  EditState state;
  state.pose = skeleton.rest_local;
  state.name = std::move(name);
  return state;
}

rig::RawClip raw_clip(const EditState& state, const rig::Skeleton& skeleton) {
  rig::RawClip raw;
  raw.name = state.name;
  raw.extrapolation = state.extrapolation;
  raw.interpolation = state.interpolation;
  for (const EditKey& key : state.keys) {
    rig::RawClip::Key& out = raw.keys.emplace_back();
    out.time = key.time;
    out.name = key.name;
    out.airborne = key.airborne;
    for (std::size_t j = 0; j < key.pose->size(); ++j) {
      const Transform &local = (*key.pose)[j], &rest = skeleton.rest_local[j];
      rig::JointKey joint;
      if (local.translation != rest.translation) joint.translation = local.translation;
      if (local.rotation.coeffs() != rest.rotation.coeffs()) joint.rotation = local.rotation;
      if (joint.translation || joint.rotation) out.joints[skeleton.names[j]] = joint;
    }
  }
  return raw;
}

std::optional<int> key_at(const EditState& state, double time) {
  for (std::size_t k = 0; k < state.keys.size(); ++k)
    if (std::abs(state.keys[k].time - time) < k_same_time) return static_cast<int>(k);
  return std::nullopt;
}

bool is_closed(const EditState& state) {
  return state.extrapolation == rig::Extrapolation::loop && state.keys.size() > 1 &&
         same_pose(*state.keys.front().pose, *state.keys.back().pose);
}

void seek(EditState& state, const rig::Skeleton& skeleton, double time) {
  if (state.keys.empty()) return;
  state.time = std::clamp(time, state.keys.front().time, state.keys.back().time);
  state.loose = false;
  state.pins.clear();
  if (const auto key = key_at(state, state.time)) {
    state.time = state.keys[*key].time;
    state.pose = *state.keys[*key].pose;
  } else {
    rig::sample(playable_clip(state, skeleton), state.time, state.pose);
  }
}

void add_next_key(EditState& state, double interval) {
  const auto pose = std::make_shared<const Pose>(state.pose);
  if (is_closed(state)) {
    EditKey& closing = state.keys.back();
    const double time = closing.time;
    closing.time += interval;
    state.keys.insert(state.keys.end() - 1, {time, "", false, pose});
    state.time = time;
  } else {
    state.time = state.keys.empty() ? 0.0 : state.keys.back().time + interval;
    state.keys.push_back({state.time, "", false, pose});
  }
  state.loose = false;
}

void set_key_here(EditState& state) {
  const auto pose = std::make_shared<const Pose>(state.pose);
  if (const auto key = key_at(state, state.time)) {
    state.keys[*key].pose = pose;
  } else {
    const EditKey added{state.time, "", false, pose};
    state.keys.insert(std::upper_bound(state.keys.begin(), state.keys.end(), added, rises), added);
  }
  state.loose = false;
}

void close_loop(EditState& state, double interval) {
  if (state.extrapolation != rig::Extrapolation::loop || state.keys.size() < 2 || is_closed(state)) return;
  const EditKey& first = state.keys.front();
  state.keys.push_back({state.keys.back().time + interval, first.name, false, first.pose});
}

void delete_key(EditState& state, int key) { state.keys.erase(state.keys.begin() + key); }

int duplicate_key(EditState& state, int key, double interval) {
  EditKey copy = state.keys[key];
  const bool last = static_cast<std::size_t>(key) + 1 == state.keys.size();
  copy.time = last ? copy.time + interval : 0.5 * (copy.time + state.keys[key + 1].time);
  state.keys.insert(state.keys.begin() + key + 1, copy);
  return move_key(state, key + 1, copy.time); // between keys that are close there is no room half way
}

int move_key(EditState& state, int key, double time) {
  EditKey moved = state.keys[key];
  moved.time = free_time(state.keys, key, time);
  state.keys.erase(state.keys.begin() + key);
  const auto place = std::upper_bound(state.keys.begin(), state.keys.end(), moved, rises);
  return static_cast<int>(state.keys.insert(place, moved) - state.keys.begin());
}

void retime_from(EditState& state, int key, double time) {
  if (key > 0) time = std::max(time, state.keys[key - 1].time + k_least_gap);
  const double shift = time - state.keys[key].time;
  for (std::size_t k = static_cast<std::size_t>(key); k < state.keys.size(); ++k) state.keys[k].time += shift;
}

} // namespace tutu::app
