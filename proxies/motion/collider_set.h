// The colliders of a scene, posed at the start and at the end of a frame.
#pragma once

#include "proxies/collider.h"
#include "proxies/motion/collider_motion.h"
#include "proxies/shapes.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tutu::proxies {

/// Colliders as plain shapes in world space at both ends of a frame. Collider i of all spans is the same one; index
/// size() is the ground, where there is one. Does not own anything.
struct SweptColliders {
  std::span<const Capsule> start, end; ///< equal lengths, equal radii and tapers
  std::optional<Plane> ground;
  /// Rotation vector of each collider from start to end, world, rad: what its surface does that its two ends do not
  /// show (a sphere has one point only). Empty: none of them turns.
  std::span<const Vec3> spin = {};
  /// The true body, for the backend that collides with it: its vertices at both ends of the frame, world, m. They go on
  /// straight lines. Empty: there is none.
  std::span<const Vec3f> body_start = {}, body_end = {};
  /// Not 0 of each collider that whoever asks does not meet: it is no candidate of anything. Empty: all are met.
  std::span<const std::uint8_t> ignored = {};

  bool meets(int collider) const { return ignored.empty() || collider >= size() || ignored[collider] == 0; }
  int size() const { return static_cast<int>(start.size()); }
  int ground_index() const { return size(); }
  bool has_body() const { return !body_start.empty(); }
  int body_index() const { return size() + 1; } ///< whether there is a ground or not
};

/// The colliders at `s` in [0, 1] of the frame, each as capsule_at has it. `out` has size() entries.
void colliders_at(const SweptColliders& colliders, double s, std::span<Capsule> out);

/// Poses proxies from joint transforms. Disabled proxies are left out. Allocates only when built.
class ColliderSet {
public:
  ColliderSet(std::vector<Proxy> proxies, std::optional<Plane> ground);

  /// Both ends of the frame at this pose: no motion. Also what a teleport or a jump in time calls.
  void reset(std::span<const Transform> world_from_joint);
  /// The frame's end becomes its start, and this pose its end.
  void advance(std::span<const Transform> world_from_joint);

  /// A collider's spin is that of the joint that carries most of its first end.
  SweptColliders swept() const { return {start_, end_, ground_, spin_}; }

  int size() const { return static_cast<int>(proxies_.size()); }
  const std::vector<Proxy>& proxies() const { return proxies_; } ///< enabled ones, in collider order
  const std::optional<Plane>& ground() const { return ground_; }

private:
  std::vector<Proxy> proxies_;
  std::optional<Plane> ground_;
  std::vector<Capsule> start_, end_;
  std::vector<Quat> rotations_; // of each collider's joint at the frame's end
  std::vector<Vec3> spin_;
};

} // namespace tutu::proxies
