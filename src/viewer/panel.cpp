#include "src/viewer/panel.h"

#include "src/render/error_colours.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <imgui.h>

namespace tutu::app {
namespace {

constexpr float k_margin = 12;       // px, between panels and the window's edge
constexpr double k_smoothing = 0.08; // share of the newest value

struct HelpLine {
  const char *keys, *what;
};
constexpr std::array<HelpLine, 14> k_help = {{{"Space", "play or pause"},
                                              {".", "one frame further"},
                                              {"Home", "back to the start"},
                                              {"[  ]", "slower, faster"},
                                              {"drag", "turn"},
                                              {"Shift or middle drag", "move aside"},
                                              {"wheel", "nearer, further"},
                                              {"R", "camera as at the start"},
                                              {"B C G", "body, cloth, ground"},
                                              {"W P K X", "wireframe, particles, skeleton, proxies"},
                                              {"E", "the skin's distance from the proxies"},
                                              {"J", "to the frame where it is worst"},
                                              {"?", "this help"},
                                              {"Esc", "quit"}}};

constexpr ImGuiWindowFlags k_panel_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                                           ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

void scale_time(ViewerState& state, float factor) {
  state.time_scale = std::clamp(state.time_scale * factor, 0.0625f, 4.0f);
}

void apply_character(unsigned character, ViewerState& state) {
  if (character == ' ') state.playing = !state.playing;
  if (character == '.') state.step_once = true;
  if (character == '?') state.help = !state.help;
  if (character == '[') scale_time(state, 0.5f);
  if (character == ']') scale_time(state, 2.0f);
  if (character == 'r' || character == 'R') state.reset_camera = true;
  if (character == 'j' || character == 'J') state.seek_worst = true;
  for (const LayerInfo& layer : k_layers)
    if (character == static_cast<unsigned>(layer.key) || character == static_cast<unsigned>(layer.key - 'a' + 'A'))
      state.layers.*layer.member = !(state.layers.*layer.member);
}

void draw_layers(ViewerState& state) {
  for (const LayerInfo& layer : k_layers) {
    ImGui::Checkbox(layer.name, &(state.layers.*layer.member));
    ImGui::SameLine(ImGui::GetFontSize() * 9);
    ImGui::TextDisabled("%c", layer.key - 'a' + 'A');
  }
}

void draw_times(const SmoothTimes& times) {
  const auto row = [](const char* name, double ms) {
    ImGui::TextUnformatted(name);
    ImGui::SameLine(ImGui::GetFontSize() * 5);
    ImGui::Text("%7.2f ms", ms);
  };
  for (const StageTime& stage : times.stages()) row(stage.name, stage.ms);
  if (!times.stages().empty()) {
    ImGui::Separator();
    row("total", times.simulation());
  }
  row("drawing", times.draw());
}

/// Play, step and restart, the time, and the speed, along the window's lower edge.
void draw_transport(const Player& player, ViewerState& state) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float width = std::min(screen.x - 2 * k_margin, ImGui::GetFontSize() * 50);
  ImGui::SetNextWindowPos({0.5f * screen.x, screen.y - k_margin}, ImGuiCond_Always, {0.5f, 1.0f});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::Begin("transport", nullptr, k_panel_flags & ~ImGuiWindowFlags_AlwaysAutoResize);
  const float em = ImGui::GetFontSize();
  if (ImGui::Button(state.playing ? "pause" : "play", {4 * em, 0})) state.playing = !state.playing;
  ImGui::SameLine();
  if (ImGui::Button("step", {3.2f * em, 0})) state.step_once = true;
  ImGui::SameLine();
  if (ImGui::Button("restart", {4.5f * em, 0})) state.restart = true;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(std::max(6 * em, ImGui::GetContentRegionAvail().x - 14 * em));
  float time = static_cast<float>(player.time());
  if (ImGui::SliderFloat("##time", &time, 0.0f, static_cast<float>(player.duration()), "%.2f s",
                         ImGuiSliderFlags_AlwaysClamp))
    state.seek = time;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(7 * em);
  ImGui::SliderFloat("##speed", &state.time_scale, 0.0625f, 4.0f, "speed %.2f",
                     ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  ImGui::SameLine();
  ImGui::Checkbox("loop", &state.loop);
  ImGui::End();
}

/// The bar of the error overlay, along the window's upper edge.
void draw_error_scale(const ErrorScale& scale) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize(), width = std::min(screen.x - 4 * k_margin, 30 * em), height = 1.1f * em;
  ImGui::SetNextWindowPos({0.5f * screen.x, k_margin}, ImGuiCond_Always, {0.5f, 0.0f});
  ImGui::Begin("error", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  ImGui::TextUnformatted(k_over_caption);
  ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + width - ImGui::CalcTextSize(k_under_caption).x);
  ImGui::TextUnformatted(k_under_caption);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  constexpr int k_parts = 128;
  const float part = width / k_parts;
  for (int k = 0; k < k_parts; ++k) {
    const auto rgb = error_srgb(scale, scale.full * (2.0 * (k + 0.5) / k_parts - 1.0));
    draw.AddRectFilled({corner.x + static_cast<float>(k) * part, corner.y},
                       {corner.x + static_cast<float>(k + 1) * part, corner.y + height},
                       ImGui::ColorConvertFloat4ToU32({rgb[0], rgb[1], rgb[2], 1}));
  }
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  draw.AddRect(corner, {corner.x + width, corner.y + height}, ink);
  for (const auto& [value, label] : error_ticks(scale)) {
    const float x = corner.x + 0.5f * (1.0f + static_cast<float>(value / scale.full)) * width;
    const float wide = ImGui::CalcTextSize(label.c_str()).x;
    draw.AddLine({x, corner.y}, {x, corner.y + height + 3}, ink);
    draw.AddText({std::clamp(x - 0.5f * wide, corner.x, corner.x + width - wide), corner.y + height + 3}, ink,
                 label.c_str());
  }
  ImGui::Dummy({width, height + 1.3f * em});
  ImGui::End();
}

void draw_message(const std::string& message) {
  if (message.empty()) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, screen.y - k_margin - 3.2f * ImGui::GetFontSize()}, ImGuiCond_Always,
                          {0.5f, 1.0f});
  ImGui::Begin("message", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  ImGui::TextColored({0.75f, 0.18f, 0.08f, 1}, "%s", message.c_str());
  ImGui::End();
}

void draw_help() {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.45f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin("help", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  for (const HelpLine& line : k_help) {
    ImGui::TextColored(ImGui::GetStyle().Colors[ImGuiCol_CheckMark], "%s", line.keys);
    ImGui::SameLine(ImGui::GetFontSize() * 14);
    ImGui::TextUnformatted(line.what);
  }
  ImGui::End();
}

} // namespace

void SmoothTimes::add(const std::vector<StageTime>& stages, double draw_ms) {
  const auto same_name = [](const StageTime& a, const StageTime& b) { return std::strcmp(a.name, b.name) == 0; };
  if (!std::equal(stages_.begin(), stages_.end(), stages.begin(), stages.end(), same_name)) stages_ = stages;
  for (std::size_t i = 0; i < stages.size(); ++i) stages_[i].ms += k_smoothing * (stages[i].ms - stages_[i].ms);
  draw_ += (draw_ > 0 ? k_smoothing : 1.0) * (draw_ms - draw_);
}

double SmoothTimes::simulation() const {
  double sum = 0;
  for (const StageTime& stage : stages_) sum += stage.ms;
  return sum;
}

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

void read_input(ViewerState& state) {
  const ImGuiIO& io = ImGui::GetIO();
  const int height = static_cast<int>(io.DisplaySize.y);
  if (!io.WantCaptureMouse) {
    const bool aside = io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift);
    if (aside) pan(state.orbit, io.MouseDelta.x, io.MouseDelta.y, height);
    else if (io.MouseDown[0]) rotate(state.orbit, io.MouseDelta.x, io.MouseDelta.y, height);
    if (io.MouseWheel != 0) zoom(state.orbit, io.MouseWheel);
  }
  if (io.WantTextInput) return;
  for (const ImWchar character : io.InputQueueCharacters) apply_character(character, state);
}

void draw_panels(const Player& player, const SmoothTimes& times, const std::optional<ErrorScale>& error_scale,
                 ViewerState& state) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({k_margin, k_margin});
  ImGui::Begin("scene", nullptr, k_panel_flags);
  ImGui::TextUnformatted(player.title().c_str());
  ImGui::Separator();
  draw_layers(state);
  if (ImGui::SmallButton(state.help ? "hide help" : "help (?)")) state.help = !state.help;
  ImGui::End();

  ImGui::SetNextWindowPos({screen.x - k_margin, k_margin}, ImGuiCond_Always, {1, 0});
  ImGui::Begin("times", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  draw_times(times);
  ImGui::End();

  draw_transport(player, state);
  if (error_scale) draw_error_scale(*error_scale);
  draw_message(player.message());
  if (state.help) draw_help();
}

} // namespace tutu::app
