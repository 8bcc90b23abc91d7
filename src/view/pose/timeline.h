// The timeline along the window's lower edge: keys to click and to move, the playhead to scrub.
#pragma once

#include "src/view/pose/editor.h"

#include <optional>

namespace tutu::app {

class Timeline {
public:
  /// Between ImGui::NewFrame and Render.
  void draw(Editor& editor);

private:
  void draw_row(Editor& editor);
  void draw_track(Editor& editor);
  void edit_key(Editor& editor);

  struct Range {
    double first = 0.0, last = 1.0; ///< s
  };
  Range range_;                    ///< held while the mouse is down: the ground must not move under a key
  std::optional<int> dragged_key_; ///< else the mouse scrubs
  bool moved_ = false;
  std::optional<int> named_key_; ///< whose name is in the box
  char name_[64] = {};
};

} // namespace tutu::app
