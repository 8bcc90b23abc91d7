// What all panels look like.
#pragma once

namespace tutu::app {

/// The look of the panels, once after ImGui has begun. `scale`: of the display, 1 = 96 dpi.
void set_panel_style(float scale);

} // namespace tutu::app
