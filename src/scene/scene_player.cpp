#include "src/scene/scene_player.h"

namespace tutu::app {

ScenePlayer::ScenePlayer(const Scene& scene, std::vector<std::vector<Vec3>> start)
    : scene_(&scene), start_(std::move(start)), session_(scene), view_(scene) {
  restart();
}

void ScenePlayer::restart() {
  session_.start(start_);
  skinned_ = false;
}

bool ScenePlayer::step() {
  session_.advance();
  skinned_ = false;
  return !session_.failure();
}

void ScenePlayer::seek(double time) {
  session_.jump(time);
  skinned_ = false;
}

std::vector<StageTime> ScenePlayer::stage_times() const {
  const FrameTimes& t = session_.times();
  return {{"pose", t.pose},   {"proxies", t.proxies}, {"broad", t.broad},
          {"cloth", t.cloth}, {"contact", t.contact}, {"skin", t.skin}};
}

std::optional<double> ScenePlayer::worst_time() {
  if (!worst_time_)
    if (const auto frame = worst_frame(*scene_, [](int, int) { return true; }))
      worst_time_ = *frame * session_.frame_seconds();
  return worst_time_;
}

FrameView ScenePlayer::view(const Layers& layers) {
  if (layers.body && !skinned_) {
    session_.skin_body();
    skinned_ = true;
  }
  return view_.frame(session_, layers);
}

} // namespace tutu::app
