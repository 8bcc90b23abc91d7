#include "src/view/play/split_player.h"

namespace tutu::app {

SplitPlayer::SplitPlayer(Side left, Side right, int frames)
    : left_(*left.scene, std::move(left.start), frames),
      right_(*right.scene, std::move(right.start), frames), captions_{std::move(left.caption),
                                                                      std::move(right.caption)} {}

void SplitPlayer::in_step() {
  left_.update();
  right_.update();
  const int common = std::min(left_.shown().index, right_.shown().index);
  left_.show(common);
  right_.show(common);
}

void SplitPlayer::rewind() {
  left_.rewind();
  right_.rewind();
  in_step();
}

void SplitPlayer::go(int frames) {
  left_.go(frames);
  right_.go(frames);
  in_step();
}

void SplitPlayer::seek(double time) {
  left_.seek(time);
  right_.seek(time);
  in_step();
}

std::string SplitPlayer::message() const {
  const std::string left = left_.message(), right = right_.message();
  if (!left.empty()) return captions_[0] + ": " + left;
  return right.empty() ? "" : captions_[1] + ": " + right;
}

std::vector<Figures> SplitPlayer::figures() {
  std::vector<Figures> both = left_.figures();
  for (const Figures& figures : right_.figures()) both.push_back(figures);
  return both;
}

std::vector<FrameView> SplitPlayer::views(const Layers& layers) {
  in_step();
  right_.compare_with(left_.shown());
  std::vector<FrameView> both;
  both.push_back(left_.draw(layers));
  both.push_back(right_.draw(layers));
  for (std::size_t k = 0; k < both.size(); ++k) both[k].caption = captions_[k];
  return both;
}

void SplitPlayer::pick(const Ray& ray) {
  left_.pick(ray);
  right_.pick_as(left_);
}

std::vector<std::vector<std::string>> SplitPlayer::why() { return {left_.why().front(), right_.why().front()}; }

} // namespace tutu::app
