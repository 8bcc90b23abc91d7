// Velocities at the keys of a cubic clip.
#include "rig/clip.h"
#include "rig/flight.h"
#include "rig/interpolation.h"

#include <algorithm>
#include <optional>

namespace tutu::rig {
namespace {

/// The segment of the clip before and after each key, by its first key; none at the end of a clip that clamps.
struct Segments {
  std::optional<std::size_t> left, right;
};

Segments segments_at(const Clip& clip, std::size_t key) {
  const std::size_t last = clip.times.size() - 1; // at least 1
  const bool loops = clip.extrapolation == Extrapolation::loop;
  Segments segments;
  if (key > 0) segments.left = key - 1;
  else if (loops) segments.left = last - 1;
  if (key < last) segments.right = key;
  else if (loops) segments.right = 0;
  return segments;
}

/// s. Keys may be so near to each other that no velocity between them is finite: those move as if they were a
/// nanosecond apart.
double duration_of(const Clip& clip, std::size_t segment) {
  constexpr double k_least = 1e-9;
  return std::max(k_least, clip.times[segment + 1] - clip.times[segment]);
}

Clip::Velocity chord(const Clip& clip, std::size_t segment, std::size_t joint) {
  const Transform& from = clip.key(static_cast<int>(segment))[joint];
  const Transform& to = clip.key(static_cast<int>(segment) + 1)[joint];
  const double h = duration_of(clip, segment);
  // About a fixed axis the angular velocity in the turning frame is the same at both ends.
  return {(to.translation - from.translation) / h, log_of(from.rotation.conjugate() * to.rotation) / h};
}

/// With which velocity a root takes off or lands at a key; none when both sides of it are on the ground.
std::optional<Vec3> flight_velocity(const Clip& clip, const Segments& at, std::size_t root) {
  const auto half_speed = [&](std::size_t segment) {
    return Vec3(0.0, 0.5 * k_gravity * duration_of(clip, segment), 0.0);
  };
  if (at.right && is_flight(clip, *at.right)) return chord(clip, *at.right, root).linear + half_speed(*at.right);
  if (at.left && is_flight(clip, *at.left)) return chord(clip, *at.left, root).linear - half_speed(*at.left);
  return std::nullopt;
}

} // namespace

void set_interpolation(Clip& clip, Interpolation interpolation) {
  clip.interpolation = interpolation;
  clip.velocities.clear();
  if (interpolation != Interpolation::cubic) return;
  const std::size_t keys = clip.times.size(), joints = static_cast<std::size_t>(clip.joint_count);
  clip.velocities.assign(keys * joints, {Vec3::Zero(), Vec3::Zero()});
  if (keys == 1) return;
  for (std::size_t k = 0; k < keys; ++k) {
    const Segments at = segments_at(clip, k);
    Clip::Velocity* velocities = clip.velocities.data() + k * joints;
    if (at.left && at.right) {
      const double h_left = duration_of(clip, *at.left), h_right = duration_of(clip, *at.right);
      for (std::size_t j = 0; j < joints; ++j) {
        const Clip::Velocity left = chord(clip, *at.left, j), right = chord(clip, *at.right, j);
        velocities[j] = {monotone_slope(left.linear, right.linear, h_left, h_right),
                         monotone_slope(left.angular, right.angular, h_left, h_right)};
      }
    }
    for (const int root : clip.roots)
      if (const auto velocity = flight_velocity(clip, at, static_cast<std::size_t>(root)))
        velocities[root].linear = *velocity;
  }
}

} // namespace tutu::rig
