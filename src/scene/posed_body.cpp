#include "src/scene/posed_body.h"

#include "rig/error.h"

#include <cmath>
#include <fmt/format.h>

namespace tutu::app {

PosedBody::PosedBody(const Scene& scene)
    : scene_(&scene), local_(scene.character.skeleton.rest_local), world_(local_.size()),
      palette_(scene.character.skin.slot_count()), positions_(scene.character.mesh.positions.size()),
      normals_(positions_.size()), colliders_(scene.proxies, std::nullopt) {
  pose_at(0.0);
}

void PosedBody::pose_at(double time) {
  rig::sample(scene_->clip, scene_->clip.times.front() + time, local_);
  rig::model_from_local(scene_->character.skeleton, local_, world_);
  rig::skinning_palette(scene_->character.skin, world_, palette_);
  rig::skin_vertices(scene_->character.mesh, scene_->character.skin, palette_, positions_, normals_);
  colliders_.reset(world_);
}

int frames_of(const Scene& scene) {
  const double frames = std::round(scene.clip.duration() * scene.description.frames_per_second);
  if (!(frames <= k_most_frames))
    throw InputError(scene.description.file.string(), "/motion", fmt::format("{:.6g} frames", frames),
                     fmt::format("at most {}", k_most_frames));
  return std::max(1, static_cast<int>(frames));
}

} // namespace tutu::app
