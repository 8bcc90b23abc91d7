// The real-time window.
#pragma once

#include "src/view/play/window_mode.h"

#include <filesystem>
#include <optional>

namespace tutu::app {

struct ViewerOptions {
  int width = 1280, height = 720;
  Layers layers = {};
  double time_scale = 1; ///< simulated seconds per second of the clock
  bool playing = true;
  bool start_at_worst = false;          ///< paused, where the skin sticks out of the proxies the most
  bool loop = true;                     ///< at the end of the motion back to its start, else stop there
  bool close_at_end = false;            ///< closes by itself with the last frame
  std::optional<int> max_frames = {};   ///< closes by itself after that many drawn frames, for tests
  std::filesystem::path browse = ".";   ///< folder in which a file to open is looked for first
  std::filesystem::path pictures = "."; ///< folder of screenshots and films
  std::vector<std::string> recent = {}; ///< files that the menu offers to open
  WindowMode* mode = nullptr;           ///< what the key M switches to
  std::string message = {};             ///< shown until something is played: what went wrong with the last file
};

/// How it was when the window closed.
struct ViewerEnd {
  Layers layers;
  bool playing = false;
  double time_scale = 1;
  int pictures = 0;                ///< drawn
  double drawing_ms = 0.0;         ///< a picture, smoothed, panels included, without waiting for the display
  std::optional<std::string> open; ///< a file that was dropped on the window or chosen: what to play next
};

/// Plays until the window is closed, another file is to be opened, Ctrl-C was caught (interrupt.h), or as the options
/// say. Throws std::runtime_error when there is no display or no OpenGL 3.3.
ViewerEnd run_viewer(Player& player, const ViewerOptions& options);

} // namespace tutu::app
