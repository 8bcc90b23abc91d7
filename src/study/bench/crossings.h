// Counts what passes through cloth, by geometry alone: double precision, no solver, no collision query.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/shapes.h"

#include <span>
#include <vector>

namespace tutu::app {

/// An end that moves on a straight line.
struct MovingPoint {
  Vec3 from, to;
};

/// +1 or -1, by the side they come from, for each moment at which the segments p q and a b pass through each other; the
/// sum.
int net_passages(const MovingPoint& p, const MovingPoint& q, const MovingPoint& a, const MovingPoint& b);

/// Whether the segment a b goes through the triangle.
bool pierces(const Vec3& a, const Vec3& b, const Vec3& t0, const Vec3& t1, const Vec3& t2);

/// Watches the axes of capsules and the surface of one gridded garment from frame to frame.
///
/// A crossing is counted on each thread (row or column of particles): the net number of times the axis has passed
/// through it within the frame, cloth and axis moving on straight lines from end to end. Net, because material that
/// slides around a limb faster than frames show it passes there and back on such lines; what stays is a thread that is
/// on another side of the limb than its ends allow. A limb that goes through cloth crosses all threads that lie across
/// it, even when it is clear of the cloth before and after.
///
/// Besides, triangles that an axis goes through at the frame's end are counted: a limb that is stuck in the cloth.
/// Spheres have no axis and are not watched.
class CrossingCounter {
public:
  explicit CrossingCounter(const cloth::Garment& garment);

  /// The state before the first frame.
  void start(std::span<const Vec3> positions, std::span<const proxies::Capsule> capsules);
  /// The state after the next one.
  void advance(std::span<const Vec3> positions, std::span<const proxies::Capsule> capsules);

  int crossings() const { return crossings_; } ///< so far
  int pierced() const { return pierced_; }     ///< triangles, summed over all frames
  int pierced_now() const { return pierced_now_; }

private:
  int crossings_of(const std::vector<int>& thread, std::span<const Vec3> positions,
                   std::span<const proxies::Capsule> capsules) const;

  const cloth::Garment* garment_;
  std::vector<std::vector<int>> threads_; ///< particles in a row; a closed one repeats its first
  std::vector<Vec3> positions_;
  std::vector<proxies::Capsule> capsules_;
  int crossings_ = 0, pierced_ = 0, pierced_now_ = 0;
};

} // namespace tutu::app
