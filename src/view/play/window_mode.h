// Another way of using the window than playing: while it is on, playing rests, and the pointer is the mode's.
#pragma once

#include "src/view/play/player.h"
#include "src/view/window/input_queue.h"
#include "src/view/window/orbit.h"

namespace tutu::app {

/// run_viewer calls it; a mode draws no more than it is asked to.
class WindowMode {
public:
  virtual ~WindowMode() = default;

  virtual bool on() const = 0;
  virtual void toggle() = 0;
  /// Before the player draws: which layers it is to draw.
  virtual Layers layers(Layers chosen) const = 0;
  /// What is seen besides; may change what the player draws, whose spans stay good.
  virtual void show(std::vector<FrameView>& views) = 0;
  /// The size of the picture, px, and how many px one of a common display is. Before the events.
  virtual void set_picture(const Camera& camera, int width, int height, float pixel_scale) = 0;
  /// `panels_have`: the pointer, or for a key the keyboard, is a panel's.
  virtual void take(const InputEvent& event, bool panels_have, OrbitCamera& orbit) = 0;
  /// Between ImGui::NewFrame and Render. `top`: px that the menus take; `panels`: whether the user wants any.
  virtual void draw_panels(float top, bool panels) = 0;

  /// The user wants to close the window. False: the mode asks first, and is_closing() once it may.
  virtual bool may_close() = 0;
  virtual bool asks() const = 0;
  virtual bool is_closing() const = 0;
};

} // namespace tutu::app
