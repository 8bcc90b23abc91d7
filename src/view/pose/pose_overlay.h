// Joints, bones, ring, pins and onion skin over the picture of the body.
#pragma once

#include "src/view/pose/editor.h"

namespace tutu::app {

/// Below all panels. Between ImGui::NewFrame and Render; the picture fills the display.
void draw_pose_overlay(const Editor& editor);

} // namespace tutu::app
