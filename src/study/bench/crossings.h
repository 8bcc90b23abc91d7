// Counts what passes through cloth of any topology, by geometry alone: no solver, no collision query.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/shapes.h"
#include "src/study/bench/threads.h"

#include <span>
#include <vector>

namespace tutu::app {

/// Watches the axes of capsules and the surface of one garment, woven or not, from frame to frame.
///
/// A crossing is counted on each thread (threads.h): the net number of times the axis has passed through it within the
/// frame, cloth and axis moving on straight lines from end to end. Net, because material that slides around a limb
/// faster than frames show it passes there and back on such lines; what stays is a thread that is on another side of
/// the limb than its ends allow. A limb that goes through cloth crosses all threads that lie across it, even when it is
/// clear of the cloth before and after. Exact for the lines as they are given (proxies/crossing/segment_passages.h): an
/// axis that meets a particle head-on crosses its thread once, and what is counted over a run is what the ends of
/// threads and axes allow, frame for frame.
///
/// Besides, triangles that an axis goes through at the frame's end are counted, exactly: a limb that is stuck in the
/// cloth. One that goes through an edge is in one of the edge's triangles (proxies/crossing/segment_triangle.h).
/// Spheres have no axis and are not watched; of pieces of thread whose ends are no numbers nothing is counted.
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
  /// Of the points of one thread, before and now.
  int crossings_of(std::span<const Vec3> before, std::span<const Vec3> now,
                   std::span<const proxies::Capsule> capsules) const;
  void place_threads(std::span<const Vec3> positions, std::vector<std::vector<Vec3>>& points) const;

  const cloth::Garment* garment_;
  std::vector<Thread> threads_;
  std::vector<std::vector<Vec3>> points_, last_points_; ///< [thread], now and before
  std::vector<proxies::Capsule> capsules_;
  int crossings_ = 0, pierced_ = 0, pierced_now_ = 0;
};

} // namespace tutu::app
