// Two scenes side by side, in step.
#pragma once

#include "src/view/play/scene_player.h"

namespace tutu::app {

/// Both show the same frame always; on the cloth of the second is painted how far it is from the first's, where both
/// have the same particles.
class SplitPlayer : public Player {
public:
  struct Side {
    const Scene* scene; ///< must outlive it
    GarmentPositions start;
    std::string caption;
  };
  /// Frames a second of both must be the same.
  SplitPlayer(Side left, Side right, int frames);

  ScenePlayer& left() { return left_; }
  ScenePlayer& right() { return right_; }

  void rewind() override;
  void go(int frames) override;
  void seek(double time) override;
  bool behind() const override { return left_.behind() || right_.behind(); }
  bool at_end() const override { return left_.at_end() || right_.at_end(); }
  double frame_seconds() const override { return left_.frame_seconds(); }
  double time() const override { return left_.time(); }
  double duration() const override { return left_.duration(); }
  std::string title() const override { return left_.title() + ", " + captions_[1]; }
  std::string message() const override;
  std::string recorded() const override { return left_.recorded(); }
  std::vector<StageTime> stage_times() const override { return left_.stage_times(); }
  std::vector<float> history() const override { return left_.history(); }
  std::vector<Figures> figures() override;
  std::optional<double> worst_time() override { return left_.worst_time(); }
  std::vector<FrameView> views(const Layers& layers) override;
  void pick(const Ray& ray) override;
  std::vector<std::vector<std::string>> why() override;

private:
  void in_step();

  ScenePlayer left_, right_;
  std::array<std::string, 2> captions_;
};

} // namespace tutu::app
