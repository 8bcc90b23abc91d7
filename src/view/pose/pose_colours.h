// The editor's colours: told apart by colour-blind people too [Okabe and Ito 2008], and by shape where it matters.
#pragma once

#include <imgui.h>

namespace tutu::app {

inline constexpr ImU32 k_joint = IM_COL32(255, 255, 255, 255);
inline constexpr ImU32 k_outline = IM_COL32(20, 30, 50, 220);
inline constexpr ImU32 k_bone = IM_COL32(20, 30, 50, 150);
inline constexpr ImU32 k_hovered = IM_COL32(240, 228, 66, 255); // yellow
inline constexpr ImU32 k_selected = IM_COL32(213, 94, 0, 255);  // vermilion
inline constexpr ImU32 k_ring = IM_COL32(213, 94, 0, 255);      // the selected joint's
inline constexpr ImU32 k_ring_far = IM_COL32(213, 94, 0, 110);
inline constexpr ImU32 k_pin = IM_COL32(0, 158, 115, 255);    // bluish green
inline constexpr ImU32 k_before = IM_COL32(0, 114, 178, 130); // blue
inline constexpr ImU32 k_after = IM_COL32(230, 159, 0, 150);  // orange
inline constexpr ImU32 k_label_back = IM_COL32(20, 30, 50, 220);
inline constexpr ImU32 k_label_ink = IM_COL32(255, 255, 255, 255);
inline constexpr ImU32 k_key = IM_COL32(70, 84, 110, 255);
inline constexpr ImU32 k_key_in_air = IM_COL32(0, 114, 178, 255);
inline constexpr ImU32 k_current_key = IM_COL32(213, 94, 0, 255);
inline constexpr ImU32 k_rule = IM_COL32(40, 50, 70, 140);
inline constexpr ImU32 k_rule_ink = IM_COL32(30, 40, 60, 255);
inline constexpr ImU32 k_track = IM_COL32(40, 56, 86, 28);

} // namespace tutu::app
