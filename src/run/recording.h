// The frames of a run, kept in memory up to a bound.
#pragma once

#include "src/run/frame_state.h"

#include <deque>
#include <memory>

namespace tutu::app {

/// Frames of neighbouring indices. When they take more than the bound the oldest go; the newest always stays. A frame
/// is never changed once it is here, so that readers keep it as long as they like.
class Recording {
public:
  using Frame = std::shared_ptr<const FrameState>;

  explicit Recording(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// The frame after the last one; any other begins the recording anew.
  void add(Frame frame);
  void clear();

  bool empty() const { return frames_.empty(); }
  int first() const { return frames_.front()->index; } ///< where there is one
  int last() const { return frames_.back()->index; }
  Frame at(int index) const; ///< null for what is not, or not any more, recorded
  std::size_t bytes() const { return bytes_; }

private:
  std::size_t most_bytes_, bytes_ = 0;
  std::deque<Frame> frames_;
};

} // namespace tutu::app
