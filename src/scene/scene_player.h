// A scene for the window to play.
#pragma once

#include "src/scene/scene_view.h"
#include "src/viewer/player.h"

namespace tutu::app {

class ScenePlayer : public Player {
public:
  /// `start`: the garments' draped positions. The scene must outlive it.
  ScenePlayer(const Scene& scene, std::vector<std::vector<Vec3>> start);

  void set_error_scale(const ErrorScale& scale) { view_.set_error_scale(scale); }

  void restart() override;
  bool step() override;
  void seek(double time) override;
  double frame_seconds() const override { return session_.frame_seconds(); }
  double time() const override { return session_.time(); }
  double duration() const override { return scene_->clip.duration(); }
  std::string title() const override { return scene_->name(); }
  std::string message() const override { return session_.failure() ? session_.failure()->message() : ""; }
  std::vector<StageTime> stage_times() const override;
  std::optional<double> worst_time() override;
  FrameView view(const Layers& layers) override;

private:
  const Scene* scene_;
  std::vector<std::vector<Vec3>> start_;
  Session session_;
  SceneView view_;
  bool skinned_ = false; ///< the body is skinned at the session's present pose
  std::optional<double> worst_time_;
};

} // namespace tutu::app
