#include "src/run/posed_body.h"

namespace tutu::app {

PosedBody::PosedBody(const Scene& scene)
    : scene_(&scene), local_(scene.character.skeleton.rest_local), world_(local_.size()),
      palette_(scene.character.skin.slot_count()), positions_(scene.character.mesh.positions.size()),
      normals_(positions_.size()), colliders_(scene.proxies, std::nullopt) {
  pose_at(0.0);
}

void PosedBody::pose_at(double time) {
  rig::pose_at(scene_->motion, scene_->character.skeleton, time, local_, world_);
  rig::skinning_palette(scene_->character.skin, world_, palette_);
  rig::skin_vertices(scene_->character.mesh, scene_->character.skin, palette_, positions_, normals_);
  colliders_.reset(world_);
}

} // namespace tutu::app
