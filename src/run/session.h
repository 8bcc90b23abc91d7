// A scene in motion: its clip, played one frame at a time on a Runtime.
#pragma once

#include "src/run/runtime.h"
#include "src/run/scene.h"

namespace tutu::app {

/// The scene must outlive it. Drawing reads from it and never changes it.
class Session : public Runtime {
public:
  explicit Session(const Scene& scene);

  /// Back to time 0 (the clip's start); garments at rest at these positions, one vector a garment (world, m), or as far
  /// off them as the scene's settings want (RunSettings::uneven_mm).
  void start(const GarmentPositions& garment_positions);

  /// Jumps to `time`: the body takes its pose there; garments as in Runtime::jump().
  void jump(double time);

  /// One frame of the clip.
  void advance();

  /// One frame towards a given pose (parent_from_joint), with more drag (1/s): how garments are draped.
  void advance_to(std::span<const Transform> local, double extra_drag);

  const Scene& scene() const { return *scene_; }
  double frame_seconds() const { return scene_->settings.frame_seconds(); }

private:
  const Scene* scene_;
  std::vector<Transform> local_, world_;
};

} // namespace tutu::app
