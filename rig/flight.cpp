#include "rig/flight.h"

#include "rig/error.h"

#include <cmath>

namespace tutu::rig {
namespace {

/// From the last key on the ground to the first one after it; the highest between them.
struct Run {
  std::size_t takeoff, landing, top;
};

void fly(Clip& clip, const Run& run, const std::string& file) {
  const auto translation = [&](std::size_t key, int joint) -> Vec3& {
    return clip.local[key * static_cast<std::size_t>(clip.joint_count) + static_cast<std::size_t>(joint)].translation;
  };
  const int root = clip.roots.front();
  const double top = translation(run.top, root).y();
  const double rise = top - translation(run.takeoff, root).y(), fall = top - translation(run.landing, root).y();
  if (!(rise > 0.0) || !(fall > 0.0))
    throw InputError(file, "clip " + clip.name + ", key " + std::to_string(run.top),
                     "an airborne root that is not above the keys on the ground around it",
                     "one key of a jump higher than take-off and landing");

  const std::vector<double> before(clip.times.begin() + static_cast<std::ptrdiff_t>(run.takeoff),
                                   clip.times.begin() + static_cast<std::ptrdiff_t>(run.landing) + 1);
  const auto old_time = [&](std::size_t key) { return before[key - run.takeoff]; };
  const double up = std::sqrt(2.0 * rise / k_gravity), down = std::sqrt(2.0 * fall / k_gravity),
               start = old_time(run.takeoff);
  for (std::size_t k = run.takeoff + 1; k <= run.top; ++k)
    clip.times[k] = start + up * ((old_time(k) - start) / (old_time(run.top) - start));
  for (std::size_t k = run.top + 1; k <= run.landing; ++k)
    clip.times[k] =
        start + up + down * ((old_time(k) - old_time(run.top)) / (old_time(run.landing) - old_time(run.top)));
  const double later = clip.times[run.landing] - old_time(run.landing);
  for (std::size_t k = run.landing + 1; k < clip.times.size(); ++k) clip.times[k] += later;

  const double duration = clip.times[run.landing] - start;
  for (const int joint : clip.roots) {
    const Vec3 from = translation(run.takeoff, joint), to = translation(run.landing, joint);
    for (std::size_t k = run.takeoff + 1; k < run.landing; ++k) {
      const double passed = clip.times[k] - start, s = passed / duration;
      translation(k, joint) = (1.0 - s) * from + s * to + above_chord(passed, duration);
    }
  }
}

} // namespace

void make_flights(Clip& clip, const std::string& file) {
  const std::size_t keys = clip.times.size();
  for (const std::size_t end : {std::size_t{0}, keys - 1})
    if (clip.airborne[end])
      throw InputError(file, "clip " + clip.name + ", key " + std::to_string(end),
                       "a clip that begins or ends in the air", "a first and a last key on the ground");
  for (std::size_t k = 1; k < keys; ++k) {
    if (!clip.airborne[k]) continue;
    Run run{k - 1, k, k};
    const auto height = [&](std::size_t key) {
      return clip.key(static_cast<int>(key))[clip.roots.front()].translation.y();
    };
    for (; clip.airborne[run.landing]; ++run.landing)
      if (height(run.landing) > height(run.top)) run.top = run.landing;
    fly(clip, run, file);
    k = run.landing;
  }
  for (std::size_t k = 1; k < keys; ++k) // a jump of some nanometres is over at once
    if (!(clip.times[k] > clip.times[k - 1]))
      throw InputError(file, "clip " + clip.name + ", key " + std::to_string(k),
                       "a time that its jumps put on that of the key before", "jumps high enough to take time");
}

} // namespace tutu::rig
