// The real-time window.
#pragma once

#include "src/viewer/player.h"

#include <optional>

namespace tutu::app {

struct ViewerOptions {
  int width = 1280, height = 800;
  Layers layers = {};
  double time_scale = 1; ///< simulated seconds per second of the clock
  bool playing = true;
  bool start_at_worst = false;        ///< paused, where the skin sticks out of the proxies the most
  bool loop = true;                   ///< at the end of the motion back to its start, else stop there
  std::optional<int> max_frames = {}; ///< closes by itself after that many drawn frames, for tests
};

/// Plays until the window is closed, Ctrl-C was caught (interrupt.h) or max_frames is reached; returns the exit status.
/// Throws std::runtime_error when there is no display or no OpenGL 3.3.
int run_viewer(Player& player, const ViewerOptions& options);

} // namespace tutu::app
