// The pose editor on the screen, and as a picture.
#pragma once

#include "src/view/pose/editor.h"
#include "src/view/render/image.h"

#include <filesystem>

namespace tutu::app {

struct PoseWindowOptions {
  int width = 1280, height = 800;
  std::filesystem::path state_file; ///< kept up to date with Editor::json(); empty: none
};

/// Until the editor is done. Prints "ready" to stdout when the first picture is on the screen. Throws
/// std::runtime_error when there is no display or no OpenGL 3.3.
void run_pose_window(Editor& editor, const PoseWindowOptions& options);

/// What the window would show, of that many pixels, without a display. Throws std::runtime_error without OpenGL.
Image draw_pose_window(Editor& editor, int width, int height);

} // namespace tutu::app
