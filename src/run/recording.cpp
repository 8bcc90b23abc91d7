#include "src/run/recording.h"

namespace tutu::app {

void Recording::add(Frame frame) {
  if (!empty() && frame->index != last() + 1) clear();
  bytes_ += frame->bytes();
  frames_.push_back(std::move(frame));
  while (bytes_ > most_bytes_ && frames_.size() > 1) {
    bytes_ -= frames_.front()->bytes();
    frames_.pop_front();
  }
}

void Recording::clear() {
  frames_.clear();
  bytes_ = 0;
}

Recording::Frame Recording::at(int index) const {
  if (empty() || index < first() || index > last()) return nullptr;
  return frames_[static_cast<std::size_t>(index - first())];
}

} // namespace tutu::app
