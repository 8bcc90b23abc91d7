#include "rig/clip.h"

#include "rig/error.h"
#include "rig/flight.h"
#include "rig/interpolation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

namespace tutu::rig {
namespace {

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// "key 3 (stand)".
std::string place_of(const RawClip& raw, std::size_t key) {
  const std::string& name = raw.keys[key].name;
  return "key " + std::to_string(key) + (name.empty() ? "" : " (" + name + ")");
}

/// Between two keys, by LERP and nlerp or slerp. What does not move keeps its bits; (1 - s) x + s x need not.
Transform blended(const Transform& from, const Transform& to, double s, Interpolation interpolation) {
  Transform result = interpolate(from, to, s);
  if (interpolation == Interpolation::slerp) result.rotation = from.rotation.slerp(s, to.rotation);
  if (from.rotation.coeffs() == to.rotation.coeffs()) result.rotation = from.rotation;
  for (int axis = 0; axis < 3; ++axis)
    if (from.translation[axis] == to.translation[axis]) result.translation[axis] = from.translation[axis];
  return result;
}

/// Between two keys, by the cubics through both with the velocities there.
Transform blended(const Transform& from, const Transform& to, const Clip::Velocity& start, const Clip::Velocity& end,
                  double h, double s) {
  Transform result;
  result.translation = hermite(from.translation, to.translation, start.linear, end.linear, h, s);
  result.rotation = from.rotation.coeffs() == to.rotation.coeffs()
                        ? from.rotation
                        : hermite(from.rotation, to.rotation, start.angular, end.angular, h, s);
  return result;
}

} // namespace

void check(const RawClip& raw) {
  if (raw.keys.empty()) throw InputError(raw.file, "clip " + raw.name, "no keys", "at least one key");
  for (std::size_t k = 0; k < raw.keys.size(); ++k) {
    const RawClip::Key& key = raw.keys[k];
    if (!(std::abs(key.time) <= k_largest_number))
      throw InputError(raw.file, place_of(raw, k), "time " + shown(key.time), "a time within +-1e9 s");
    if (k > 0 && !(key.time > raw.keys[k - 1].time))
      throw InputError(raw.file, place_of(raw, k),
                       "time " + shown(key.time) + " s after " + shown(raw.keys[k - 1].time) + " s of the key before",
                       "strictly rising times");
    for (const auto& [name, joint] : key.joints) {
      const std::string place = place_of(raw, k) + ", joint " + name;
      if (joint.translation &&
          !(joint.translation->cwiseAbs().maxCoeff() <= k_largest_number && is_finite(*joint.translation)))
        throw InputError(raw.file, place, "a translation beyond all bounds", "finite numbers within +-1e9 m");
      if (joint.rotation && !(std::abs(joint.rotation->norm() - 1.0) < 1e-6))
        throw InputError(raw.file, place, "a rotation of length " + shown(joint.rotation->norm()), "a unit quaternion");
    }
  }
}

Clip build_clip(const RawClip& raw, const Skeleton& skeleton) {
  check(raw);
  const auto joint_count = static_cast<std::size_t>(skeleton.joint_count());
  Clip clip;
  clip.name = raw.name;
  clip.extrapolation = raw.extrapolation;
  clip.joint_count = skeleton.joint_count();
  clip.times.reserve(raw.keys.size());
  clip.local.reserve(raw.keys.size() * joint_count);

  std::vector<const std::string*> named(joint_count); // by which name of this key each joint was set
  for (std::size_t k = 0; k < raw.keys.size(); ++k) {
    clip.times.push_back(raw.keys[k].time);
    clip.local.insert(clip.local.end(), skeleton.rest_local.begin(), skeleton.rest_local.end());
    Transform* local = clip.local.data() + k * joint_count;
    std::fill(named.begin(), named.end(), nullptr);
    for (const auto& [name, key] : raw.keys[k].joints) {
      const std::string place = place_of(raw, k) + ", joint " + name;
      const std::optional<int> joint = skeleton.find(name);
      if (!joint)
        throw InputError(raw.file, place, "a joint the skeleton lacks, or has more than once", "one of its joints");
      if (named[*joint])
        throw InputError(raw.file, place, "the same joint as " + *named[*joint], "every joint of a key once");
      named[*joint] = &name;
      if (key.translation) local[*joint].translation = *key.translation;
      if (key.rotation) local[*joint].rotation = *key.rotation;
    }
    clip.airborne.push_back(raw.keys[k].airborne);
  }
  clip.roots = roots_of(skeleton);
  make_flights(clip, raw.file);
  set_interpolation(clip, raw.interpolation);
  return clip;
}

double wrapped(double time, double start, double end) {
  if (!(end > start) || (time >= start && time <= end)) return end > start ? time : start;
  double offset = std::fmod(time - start, end - start); // exact; has the sign of time - start
  if (offset < 0.0) offset += end - start;
  return start + offset;
}

void sample(const Clip& clip, double time, std::span<Transform> local) {
  assert(local.size() == static_cast<std::size_t>(clip.joint_count));
  const double t =
      clip.extrapolation == Extrapolation::loop ? wrapped(time, clip.times.front(), clip.times.back()) : time;
  const auto after = std::upper_bound(clip.times.begin(), clip.times.end(), t);
  // NaN compares as behind every key; it is held at the first one, as is what lies before it.
  const auto held = [&](int k) { std::ranges::copy(clip.key(k), local.begin()); };
  if (!(t > clip.times.front())) return held(0);
  if (after == clip.times.end()) return held(static_cast<int>(clip.times.size()) - 1);

  const int k = static_cast<int>(after - clip.times.begin()) - 1;
  if (t == clip.times[k]) return held(k);
  const double h = clip.times[k + 1] - clip.times[k], s = (t - clip.times[k]) / h;
  const std::span<const Transform> from = clip.key(k), to = clip.key(k + 1);
  if (clip.interpolation == Interpolation::cubic) {
    const Clip::Velocity* start = clip.velocities.data() + static_cast<std::size_t>(k) * local.size();
    const Clip::Velocity* end = start + local.size();
    for (std::size_t j = 0; j < local.size(); ++j) local[j] = blended(from[j], to[j], start[j], end[j], h, s);
  } else {
    for (std::size_t j = 0; j < local.size(); ++j) local[j] = blended(from[j], to[j], s, clip.interpolation);
  }
  if (!is_flight(clip, k)) return;
  for (const int root : clip.roots)
    local[root].translation =
        (1.0 - s) * from[root].translation + s * to[root].translation + above_chord(t - clip.times[k], h);
}

Interpolation interpolation_named(std::string_view name) {
  const auto found = std::find(k_interpolation_names.begin(), k_interpolation_names.end(), name);
  assert(found != k_interpolation_names.end());
  return static_cast<Interpolation>(found - k_interpolation_names.begin());
}

void pose_at(const Clip& clip, const Skeleton& skeleton, double time, std::span<Transform> local,
             std::span<Transform> model) {
  sample(clip, clip.times.front() + time, local);
  model_from_local(skeleton, local, model);
}

} // namespace tutu::rig
