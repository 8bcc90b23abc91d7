// What lies over the picture: transport, layers, timings, messages, help.
#pragma once

#include "src/viewer/orbit.h"
#include "src/viewer/player.h"

#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// What the user has set.
struct ViewerState {
  OrbitCamera orbit;
  Layers layers;
  bool playing = true, loop = true, help = false;
  float time_scale = 1;
  // What the user has asked for since the last frame; run_viewer does it and clears it.
  bool step_once = false, restart = false, reset_camera = false, quit = false, seek_worst = false;
  std::optional<double> seek; ///< s
};

/// Milliseconds, smoothed so that a person can read them.
class SmoothTimes {
public:
  void add(const std::vector<StageTime>& stages, double draw_ms);
  const std::vector<StageTime>& stages() const { return stages_; }
  double simulation() const; ///< all stages together
  double draw() const { return draw_; }

private:
  std::vector<StageTime> stages_;
  double draw_ = 0;
};

/// The look of the panels, once after ImGui has begun. `scale`: of the display, 1 = 96 dpi.
void set_panel_style(float scale);

/// Characters and mouse of this frame, as far as no panel wants them. Between ImGui::NewFrame and Render.
/// Keys without a character (Home, Esc) come by run_viewer's own callback.
void read_input(ViewerState& state);

/// All panels; with a scale also the bar of the error overlay. Between ImGui::NewFrame and Render.
void draw_panels(const Player& player, const SmoothTimes& times, const std::optional<ErrorScale>& error_scale,
                 ViewerState& state);

} // namespace tutu::app
