// Counts what passes through cloth of any topology, by geometry alone: no solver, no collision query.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/shapes.h"
#include "src/study/bench/threads.h"

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

/// Watches the axes of capsules and the surface of one garment, woven or not, from frame to frame.
///
/// A crossing is counted on each thread (threads.h): the net number of times the axis has passed through it within the
/// frame, cloth and axis moving on straight lines from end to end. Net, because material that slides around a limb
/// faster than frames show it passes there and back on such lines; what stays is a thread that is on another side of
/// the limb than its ends allow. A limb that goes through cloth crosses all threads that lie across it, even when it is
/// clear of the cloth before and after. The moments are roots of cubics in double, not exact: an axis is watched 1 nm
/// beside its place, so that one which meets a particle head-on is counted once.
///
/// Besides, triangles that an axis goes through at the frame's end are counted, exactly: a limb that is stuck in the
/// cloth. One that goes through an edge is in one of the edge's triangles (proxies/crossing/segment_triangle.h).
/// Spheres have no axis and are not watched; of positions that are no numbers nothing is counted.
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
  int crossings_of(const Thread& thread, std::span<const Vec3> positions,
                   std::span<const proxies::Capsule> capsules) const;

  const cloth::Garment* garment_;
  std::vector<Thread> threads_;
  std::vector<Vec3> positions_;
  std::vector<proxies::Capsule> capsules_;
  int crossings_ = 0, pierced_ = 0, pierced_now_ = 0;
};

/// Connected curves of intersection now (proxies/crossing/surface_crossings.h): what the axes do not show. Limbs are
/// polyhedra, up to 0.4 % of their radius thinner than they are. Layers of cloth that lie exactly on each other are
/// told apart by the rest shape; the lips of a slit that is shut to the last bit are not, and may count.
struct SurfacesThrough {
  int colliders = 0; ///< cloth with the surfaces of capsules and spheres
  int cloth = 0;     ///< cloth with itself
};

SurfacesThrough surfaces_through(const cloth::Garment& garment, std::span<const Vec3> positions,
                                 std::span<const proxies::Capsule> capsules);

} // namespace tutu::app
