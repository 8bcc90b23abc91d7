// What lies over the picture: menus, layers and their legend, figures, the answer to "why", transport, messages, help.
#pragma once

#include "src/view/play/viewer_commands.h"

namespace tutu::app {

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

/// Characters and mouse of this frame, as far as no panel wants them. `with_mouse`: false leaves it to a mode. Between
/// ImGui::NewFrame and Render. Keys without a character (Home, Esc) come by run_viewer's own callback.
void read_input(ViewerState& state, bool with_mouse);

/// All panels; with a scale also the bar of the error overlay. `recent`: files to offer. Between ImGui::NewFrame and
/// Render.
void draw_panels(Player& player, const SmoothTimes& times, std::span<const FrameView> views,
                 std::span<const std::string> recent, ViewerState& state);

} // namespace tutu::app
