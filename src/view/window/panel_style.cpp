#include "src/view/window/panel_style.h"

#include <imgui.h>

namespace tutu::app {

void set_panel_style(float scale) {
  ImGui::StyleColorsLight();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 8;
  style.FrameRounding = 5;
  style.GrabRounding = 5;
  style.WindowBorderSize = 0;
  style.WindowPadding = {12, 10};
  style.ItemSpacing = {8, 5};
  style.Colors[ImGuiCol_WindowBg] = {1, 1, 1, 0.72f};
  style.Colors[ImGuiCol_FrameBg] = {0.16f, 0.22f, 0.34f, 0.10f};
  style.Colors[ImGuiCol_Button] = {0.16f, 0.22f, 0.34f, 0.12f};
  style.Colors[ImGuiCol_CheckMark] = {0.62f, 0.10f, 0.22f, 1};
  style.Colors[ImGuiCol_SliderGrab] = {0.62f, 0.10f, 0.22f, 0.75f};
  style.Colors[ImGuiCol_SliderGrabActive] = {0.62f, 0.10f, 0.22f, 1};
  style.ScaleAllSizes(scale);
  ImFontConfig font;
  font.SizePixels = 13.0f * scale;
  ImGui::GetIO().Fonts->AddFontDefault(&font);
}

} // namespace tutu::app
