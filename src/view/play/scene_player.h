// A scene for the window to play.
#pragma once

#include "src/run/simulation.h"
#include "src/view/play/player.h"
#include "src/view/show/scene_view.h"
#include "src/view/show/why.h"
#include "src/view/show/why_edge.h"

#include <memory>

namespace tutu::app {

/// Memory of recorded frames: 4000 of the dance's, more than a minute.
inline constexpr std::size_t k_recording_bytes = std::size_t{256} << 20;

/// Simulates on a thread of its own, some frames ahead of what is shown.
class ScenePlayer : public Player {
public:
  /// `start`: the garments' draped positions; `frames`: of the motion that are played. The scene must outlive it.
  ScenePlayer(const Scene& scene, GarmentPositions start, int frames);

  void set_error_scale(const ErrorScale& scale) { view_.set_error_scale(scale); }

  void rewind() override;
  void go(int frames) override;
  void seek(double time) override;
  bool behind() const override { return shown_->index != target_; }
  bool at_end() const override;
  double frame_seconds() const override { return 1.0 / scene_->settings.frames_per_second; }
  double time() const override { return shown_->time; }
  double duration() const override { return frames_ * frame_seconds(); }
  std::string title() const override { return scene_->name(); }
  std::string message() const override { return simulation_->message(); }
  std::string recorded() const override;
  std::vector<StageTime> stage_times() const override;
  std::vector<float> history() const override;
  std::vector<Figures> figures() override;
  std::optional<double> worst_time() override;
  std::vector<FrameView> views(const Layers& layers) override;
  void pick(const Ray& ray) override;
  void pick(std::size_t garment, int particle);
  std::vector<std::vector<std::string>> why() override;

  const Scene& scene() const { return *scene_; }
  const FrameState& shown() const { return *shown_; }
  /// Ends the simulation, so that the scene may change: its proxies only. Nothing but restart() may be called then.
  void stop() { simulation_.reset(); }
  void restart(GarmentPositions start); ///< the scene as it is now, from that draped start
  SkinView shown_skin();                ///< good until another frame is shown

  void update();                        ///< shows what was asked for, as far as it is there
  void show(int index);                 ///< this frame for now, where it is recorded
  FrameView draw(const Layers& layers); ///< what is shown
  /// From now on paints how far cloth is from that of another state (k_apart_scale); copied.
  void compare_with(const FrameState& other) { other_ = other; }
  void pick_as(const ScenePlayer& other); ///< the same particle, where there is one

  Simulation::Extent extent() const { return simulation_->extent(); }
  /// Of the particle that is picked, at the frame that is shown, back to the start of what is recorded.
  std::optional<Why> why_shown();
  std::optional<WhyEdge> why_edge() const;   ///< of the edge that is picked
  std::optional<WhyProxy> why_proxy() const; ///< of the proxy that is picked

private:
  void jump(); ///< to the target
  void forget_first_wrong();
  void pick_particle(const Ray& ray);
  void pick_edge(const Ray& ray); ///< in the place of the particle, where the ray passes an edge's middle nearer
  void pick_proxy(const Ray& ray);
  void skin();
  void add_picked(FrameView& view);

  const Scene* scene_;
  int frames_;
  std::unique_ptr<Simulation> simulation_;
  int target_ = 0; ///< the frame that is asked for; shown as soon as it is there
  Recording::Frame shown_;
  SceneView view_;
  std::vector<rig::SkinMatrix> palette_;
  std::vector<Vec3f> body_positions_, body_normals_;
  int skinned_ = -1; ///< frame that the body is skinned for
  struct Picked {
    std::size_t garment;
    int particle;
  };
  std::optional<Picked> picked_;
  std::optional<int> picked_edge_; ///< spring of the picked particle's garment
  std::optional<int> picked_proxy_;
  Layers drawn_;                          ///< only what is seen can be picked
  std::optional<FirstWrong> first_wrong_; ///< of it, among the frames up to
  int looked_at_ = -1;                    ///< this one
  std::vector<Touch> touches_;
  std::optional<FrameState> other_;
  std::optional<double> worst_time_;
};

} // namespace tutu::app
