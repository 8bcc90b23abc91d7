// What the user can do in the window: one table for keys, menus and the help sheet.
#pragma once

#include "src/view/play/player.h"
#include "src/view/window/orbit.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::app {

/// What the user has set.
struct ViewerState {
  OrbitCamera orbit;
  Layers layers;
  bool playing = true, loop = true, help = false, panels = true;
  bool in_mode = false; ///< the window is used in another way (WindowMode): its panels take the place of the figures
  float time_scale = 1;
  // What the user has asked for since the last frame; run_viewer does it and clears it.
  int steps = 0; ///< frames on or back
  bool rewind = false, reset_camera = false, quit = false, seek_worst = false;
  bool screenshot = false, toggle_film = false, browse = false, toggle_mode = false;
  std::optional<double> seek;           ///< s
  std::optional<Eigen::Vector2f> click; ///< on the picture, pixels from its upper left corner
  std::optional<std::string> open;      ///< a file
  std::optional<std::string> open_then; ///< the file, once the mode is asked whether it may close
  std::string note;                     ///< what was last done, for the user
};

struct ViewerCommand {
  const char* menu;
  const char* label;
  const char* shortcut; ///< as people call it
  char character = 0;   ///< that the key writes, without Shift; or
  int key = 0;          ///< GLFW's number of a key that writes none
  void (*act)(ViewerState&) = nullptr;
};

/// Menu by menu. The layers (k_layers) come on top of these.
std::span<const ViewerCommand> viewer_commands();

void apply_character(unsigned character, ViewerState& state); ///< layers included
void apply_key(int key, ViewerState& state);

} // namespace tutu::app
