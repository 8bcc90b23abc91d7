#include "src/run/session.h"

#include "cloth/garment/uneven.h"
#include "src/base/stopwatch.h"

namespace tutu::app {

Session::Session(const Scene& scene)
    : Runtime(scene), scene_(&scene), local_(scene.character.skeleton.rest_local), world_(local_.size()) {}

void Session::start(const GarmentPositions& garment_positions) {
  rig::pose_at(scene_->motion, scene_->character.skeleton, 0.0, local_, world_);
  if (scene_->settings.uneven_mm == 0.0) return Runtime::start(world_, garment_positions);
  GarmentPositions uneven = garment_positions;
  std::mt19937_64 random(static_cast<std::uint64_t>(scene_->settings.seed));
  for (std::size_t g = 0; g < uneven.size(); ++g)
    cloth::make_uneven(scene_->garments[g], 1e-3 * scene_->settings.uneven_mm, random, uneven[g]);
  Runtime::start(world_, uneven);
}

void Session::jump(double time) {
  rig::pose_at(scene_->motion, scene_->character.skeleton, time, local_, world_);
  Runtime::jump(world_, time);
}

void Session::advance() {
  if (failure() || stopped()) return;
  Stopwatch watch;
  rig::sample(scene_->motion, scene_->motion.start() + time() + frame_seconds(), local_);
  const double sampling = watch.lap();
  advance_to(local_, 0.0);
  times_.pose += sampling;
}

void Session::advance_to(std::span<const Transform> local, double extra_drag) {
  if (failure() || stopped()) return;
  Stopwatch watch;
  rig::model_from_local(scene_->character.skeleton, local, world_);
  const double kinematics = watch.lap();
  step(world_, frame_seconds(), extra_drag);
  times_.pose = kinematics;
}

} // namespace tutu::app
