#include "src/view/play/panel.h"

#include "src/view/render/error_colours.h"
#include "src/view/render/legend.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <imgui.h>

namespace tutu::app {
namespace {

constexpr float k_margin = 12;       // px, between panels and the window's edge
constexpr double k_smoothing = 0.08; // share of the newest value

constexpr ImGuiWindowFlags k_panel_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                                           ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// Of the mouse; keys stand in viewer_commands() and k_layers.
constexpr std::array<std::array<const char*, 2>, 5> k_mouse = {{{"drag", "turn"},
                                                                {"Shift or middle drag", "move aside"},
                                                                {"wheel", "nearer, further"},
                                                                {"click", "why that particle, edge or proxy is so"},
                                                                {"drop a file", "play that scene or character"}}};

void draw_menus(std::span<const std::string> recent, ViewerState& state) {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const char* menu : {"File", "Edit", "Run", "View"}) {
    if (!ImGui::BeginMenu(menu)) continue;
    const std::string_view name = menu;
    if (name == "File" && !recent.empty() && ImGui::BeginMenu("open again")) {
      for (const std::string& file : recent)
        if (ImGui::MenuItem(file.c_str())) state.open = file;
      ImGui::EndMenu();
    }
    for (const ViewerCommand& command : viewer_commands())
      if (name == command.menu && ImGui::MenuItem(command.label, command.shortcut)) command.act(state);
    if (name == "View") {
      ImGui::Separator();
      for (const LayerInfo& layer : k_layers) {
        const char key[] = {static_cast<char>(layer.key - 'a' + 'A'), 0};
        ImGui::MenuItem(layer.name, key, &(state.layers.*layer.member));
      }
    }
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

void draw_layers(ViewerState& state) {
  for (const LayerInfo& layer : k_layers) {
    ImGui::Checkbox(layer.name, &(state.layers.*layer.member));
    ImGui::SameLine(ImGui::GetFontSize() * 9);
    ImGui::TextDisabled("%c", layer.key - 'a' + 'A');
  }
}

void draw_legend_panel(std::span<const LegendEntry> legend) {
  if (legend.empty()) return;
  ImGui::SetNextWindowPos({k_margin, ImGui::GetIO().DisplaySize.y - k_margin - 3.2f * ImGui::GetFontSize()},
                          ImGuiCond_Always, {0, 1});
  ImGui::Begin("legend", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  for (const LegendEntry& entry : legend) {
    const auto rgb = srgb_of(entry.colour);
    const float side = ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos(), far_corner = {corner.x + side, corner.y + side};
    ImGui::GetWindowDrawList()->AddRectFilled(corner, far_corner,
                                              ImGui::ColorConvertFloat4ToU32({rgb[0], rgb[1], rgb[2], 1}));
    ImGui::GetWindowDrawList()->AddRect(corner, far_corner, ImGui::GetColorU32(ImGuiCol_TextDisabled));
    ImGui::Dummy({side, side});
    ImGui::SameLine();
    ImGui::TextUnformatted(entry.text.c_str());
  }
  ImGui::End();
}

void draw_figures(Player& player) {
  const std::vector<float> history = player.history();
  if (!history.empty()) {
    float most = 0;
    for (const float ms : history) most = std::max(most, ms);
    char caption[32];
    std::snprintf(caption, sizeof caption, "ms, up to %.2f", static_cast<double>(most));
    ImGui::PlotLines("##history", history.data(), static_cast<int>(history.size()), 0, caption, 0, 1.2f * most,
                     {ImGui::GetFontSize() * 11, ImGui::GetFontSize() * 3.5f});
  }
  const std::vector<Figures> figures = player.figures();
  if (figures.empty()) return;
  ImGui::Separator();
  const auto row = [&](const char* name, const char* format, const auto& value) {
    ImGui::TextUnformatted(name);
    for (std::size_t k = 0; k < figures.size(); ++k) {
      ImGui::SameLine(ImGui::GetFontSize() * (5.5f + 5.0f * static_cast<float>(k)));
      ImGui::Text(format, value(figures[k]));
    }
  };
  row("frame", "%8d", [](const Figures& f) { return f.frame; });
  if (figures.size() > 1) row("ms", "%8.2f", [](const Figures& f) { return f.ms; });
  row("particles", "%8d", [](const Figures& f) { return f.particles; });
  row("touching", "%8d", [](const Figures& f) { return f.contacts; });
  row("substeps", "%8d", [](const Figures& f) { return f.substeps; });
  row("recoveries", "%8d", [](const Figures& f) { return f.recoveries; });
  row("deepest mm", "%8.2f", [](const Figures& f) { return 1000.0 * f.deepest; });
  for (const Figures& f : figures) ImGui::TextDisabled("state %016llx", static_cast<unsigned long long>(f.state_hash));
  if (const std::string recorded = player.recorded(); !recorded.empty()) ImGui::TextDisabled("%s", recorded.c_str());
}

/// Along the right edge of each view's part of the window: the last one below the figures (px), others at the bottom.
void draw_why(const std::vector<std::vector<std::string>>& sides, float below_figures) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float part = screen.x / static_cast<float>(std::max<std::size_t>(1, sides.size()));
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (sides[k].empty()) continue;
    const float right = static_cast<float>(k + 1) * part - k_margin;
    if (k + 1 == sides.size()) ImGui::SetNextWindowPos({right, below_figures}, ImGuiCond_Always, {1, 0});
    else ImGui::SetNextWindowPos({right, screen.y - k_margin - 3.2f * ImGui::GetFontSize()}, ImGuiCond_Always, {1, 1});
    ImGui::Begin(k == 0 ? "why" : "why beside", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
    for (const std::string& line : sides[k]) ImGui::TextUnformatted(line.c_str());
    ImGui::End();
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
  if (ImGui::Button("<", {1.8f * em, 0})) --state.steps;
  ImGui::SameLine();
  if (ImGui::Button(">", {1.8f * em, 0})) ++state.steps;
  ImGui::SameLine();
  if (ImGui::Button("start", {3.4f * em, 0})) state.rewind = true;
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
void draw_error_scale(const ErrorScale& scale, float top) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize(), width = std::min(screen.x - 4 * k_margin, 30 * em), height = 1.1f * em;
  ImGui::SetNextWindowPos({0.5f * screen.x, top}, ImGuiCond_Always, {0.5f, 0.0f});
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

void draw_message(const std::string& message, bool bad) {
  if (message.empty()) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, screen.y - k_margin - 3.2f * ImGui::GetFontSize()}, ImGuiCond_Always,
                          {0.5f, 1.0f});
  ImGui::Begin("message", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  if (bad) ImGui::TextColored({0.75f, 0.18f, 0.08f, 1}, "%s", message.c_str());
  else ImGui::TextUnformatted(message.c_str());
  ImGui::End();
}

void draw_help() {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(0.94f);
  ImGui::Begin("help", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  const auto cells = [](const char* keys, const char* what) {
    ImGui::TableNextColumn();
    ImGui::TextColored(ImGui::GetStyle().Colors[ImGuiCol_CheckMark], "%s", keys);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(what);
  };
  if (ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit)) {
    const std::span<const ViewerCommand> commands = viewer_commands();
    for (std::size_t row = 0; row < commands.size() + k_mouse.size(); ++row) {
      ImGui::TableNextRow();
      if (row < commands.size()) cells(commands[row].shortcut, commands[row].label);
      else cells(k_mouse[row - commands.size()][0], k_mouse[row - commands.size()][1]);
      if (row >= k_layers.size()) continue;
      const char key[] = {static_cast<char>(k_layers[row].key - 'a' + 'A'), 0};
      cells(key, k_layers[row].what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

/// The scene's name and its layers.
void draw_scene(const Player& player, ViewerState& state, float top) {
  ImGui::SetNextWindowPos({k_margin, top});
  ImGui::Begin("scene", nullptr, k_panel_flags);
  ImGui::TextUnformatted(player.title().c_str());
  ImGui::Separator();
  draw_layers(state);
  if (ImGui::SmallButton(state.help ? "hide help" : "help (?)")) state.help = !state.help;
  ImGui::End();
}

/// Times and figures; returns where there is room below them, px.
float draw_measures(Player& player, const SmoothTimes& times, const ImVec2& corner) {
  ImGui::SetNextWindowPos(corner, ImGuiCond_Always, {1, 0});
  ImGui::Begin("times", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  draw_times(times);
  draw_figures(player);
  const float below = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y + k_margin;
  ImGui::End();
  return below;
}

void draw_captions(std::span<const FrameView> views) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float part = screen.x / static_cast<float>(views.size());
  for (std::size_t k = 0; k < views.size(); ++k) {
    if (views[k].caption.empty()) continue;
    const ImVec2 size = ImGui::CalcTextSize(views[k].caption.c_str());
    const float left = (static_cast<float>(k) + 0.5f) * part - 0.5f * size.x, top = ImGui::GetFrameHeight() + k_margin;
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled({left - 8, top}, {left + size.x + 8, top + size.y + 8}, ImGui::GetColorU32(ImGuiCol_WindowBg),
                       5);
    draw.AddText({left, top + 4}, ImGui::GetColorU32(ImGuiCol_Text), views[k].caption.c_str());
  }
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

void read_input(ViewerState& state, bool with_mouse) {
  const ImGuiIO& io = ImGui::GetIO();
  const int height = static_cast<int>(io.DisplaySize.y);
  if (!io.WantCaptureMouse && with_mouse) {
    const bool aside = io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift);
    if (aside) pan(state.orbit, io.MouseDelta.x, io.MouseDelta.y, height);
    else if (io.MouseDown[0]) rotate(state.orbit, io.MouseDelta.x, io.MouseDelta.y, height);
    if (io.MouseWheel != 0) zoom(state.orbit, io.MouseWheel);
    constexpr float k_still = 4; // px: a hand that clicks
    if (ImGui::IsMouseReleased(0) && !io.KeyShift && io.MouseDragMaxDistanceSqr[0] < k_still * k_still)
      state.click = Eigen::Vector2f(io.MousePos.x, io.MousePos.y);
  }
  if (io.WantTextInput) return;
  for (const ImWchar character : io.InputQueueCharacters) apply_character(character, state);
}

void draw_panels(Player& player, const SmoothTimes& times, std::span<const FrameView> views,
                 std::span<const std::string> recent, ViewerState& state) {
  if (!state.panels) return;
  const FrameView& view = views.back(); // its legend says more where there are two
  draw_menus(recent, state);
  const float top = ImGui::GetFrameHeight() + k_margin, right = ImGui::GetIO().DisplaySize.x - k_margin;
  if (!state.in_mode) {
    draw_scene(player, state, top);
    const float below = draw_measures(player, times, {right, top});
    draw_why(player.why(), below);
  }
  draw_legend_panel(view.legend);
  draw_transport(player, state);
  draw_captions(views);
  if (view.error_scale) draw_error_scale(*view.error_scale, top);
  const std::string message = player.message();
  draw_message(message.empty() ? state.note : message, !message.empty());
  if (state.help) draw_help();
}

} // namespace tutu::app
