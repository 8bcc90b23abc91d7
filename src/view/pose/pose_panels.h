// Menus, the selected joint, messages, questions and the help sheet.
#pragma once

#include "src/view/pose/editor.h"

namespace tutu::app {

/// What ImGuiSession's style lacks for menus and dialogs. Once, after it has begun.
void set_pose_style();

/// All but the timeline. Between ImGui::NewFrame and Render.
void draw_pose_panels(Editor& editor);

} // namespace tutu::app
