#include "tests/instructions/counted_frames.h"

extern "C" void tutu_counted_frames(const std::function<void()>& frame, int frames) {
  for (int k = 0; k < frames; ++k) frame();
}
