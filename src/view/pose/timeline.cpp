#include "src/view/pose/timeline.h"

#include "src/view/pose/pose_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <imgui.h>

namespace tutu::app {
namespace {

/// The least of 1, 2, 5 times a power of ten that is at least `least`.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10.0 * power;
}

bool command_button(Editor& editor, EditorCommand command, const char* label) {
  const bool hit = ImGui::Button(label);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s (%s)", entry_of(command).label, entry_of(command).keys);
  if (hit) editor.run(command);
  ImGui::SameLine();
  return hit;
}

} // namespace

void Timeline::edit_key(Editor& editor) {
  const float em = ImGui::GetFontSize();
  const auto key = editor.current_key();
  if (!key) {
    ImGui::AlignTextToFramePadding();
    if (editor.state().keys.empty()) ImGui::TextDisabled("no keys yet");
    else ImGui::TextDisabled("%.2f s, between keys", editor.state().time);
    named_key_.reset();
    return;
  }
  double time = editor.state().keys[*key].time;
  ImGui::SetNextItemWidth(5.5f * em);
  if (ImGui::InputDouble("##time", &time, 0, 0, "%.3f s", ImGuiInputTextFlags_EnterReturnsTrue)) {
    editor.show_key_moved(*key, time, ImGui::GetIO().KeyCtrl);
    editor.keep();
    return;
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("time of the key");
  ImGui::SameLine();
  if (!ImGui::IsAnyItemActive() || named_key_ != key)
    std::snprintf(name_, sizeof name_, "%s", editor.state().keys[*key].name.c_str());
  named_key_ = key;
  ImGui::SetNextItemWidth(8 * em);
  if (ImGui::InputTextWithHint("##name", "name of the key", name_, sizeof name_, ImGuiInputTextFlags_EnterReturnsTrue))
    editor.rename_key(*key, name_);
}

void Timeline::draw_row(Editor& editor) {
  const float em = ImGui::GetFontSize();
  command_button(editor, EditorCommand::save_key, "save as next key");
  command_button(editor, EditorCommand::set_key_here, "key here");
  command_button(editor, EditorCommand::previous_key, "<##before");
  command_button(editor, EditorCommand::next_key, ">##after");
  command_button(editor, EditorCommand::duplicate_key, "duplicate");
  command_button(editor, EditorCommand::delete_key, "delete");
  edit_key(editor);
  constexpr float k_one_row = 58, k_interval = 12.5; // em; where there is no room it has a row of its own
  if (ImGui::GetWindowWidth() > k_one_row * em) ImGui::SameLine(ImGui::GetWindowWidth() - k_interval * em);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("next after");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(5 * em);
  double interval = editor.interval();
  if (ImGui::InputDouble("##interval", &interval, 0, 0, "%.2f s", ImGuiInputTextFlags_EnterReturnsTrue) &&
      interval >= 0.01 && interval <= 1000.0)
    editor.set_interval(interval);
}

void Timeline::draw_track(Editor& editor) {
  const EditState& state = editor.state();
  const float em = ImGui::GetFontSize(), diamond = 0.45f * em;
  const ImVec2 size(ImGui::GetContentRegionAvail().x, 3.0f * em), corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("track", size);
  const bool active = ImGui::IsItemActive(), begun = ImGui::IsItemActivated();
  if (!active || begun) {
    range_.first = state.keys.empty() ? 0.0 : std::min(0.0, state.keys.front().time);
    range_.last = state.keys.empty() ? 1.0 : std::max(range_.first + 1.0, state.keys.back().time + editor.interval());
  }
  const float left = corner.x + em, wide = std::max(1.0f, size.x - 2 * em), middle = corner.y + 1.9f * em;
  const auto x_of = [&](double time) {
    return left + wide * static_cast<float>((time - range_.first) / (range_.last - range_.first));
  };
  const float mouse = ImGui::GetIO().MousePos.x;
  const double time_under = range_.first + (range_.last - range_.first) * (mouse - left) / wide;

  if (begun) {
    dragged_key_.reset();
    moved_ = false;
    for (std::size_t k = 0; k < state.keys.size(); ++k)
      if (std::abs(x_of(state.keys[k].time) - mouse) <= diamond + 2) dragged_key_ = static_cast<int>(k);
    editor.scrub(dragged_key_ ? state.keys[*dragged_key_].time : time_under);
  } else if (active && !dragged_key_) {
    editor.scrub(time_under);
  } else if (active) {
    moved_ = moved_ || ImGui::IsMouseDragging(ImGuiMouseButton_Left, 3);
    if (moved_) dragged_key_ = editor.show_key_moved(*dragged_key_, time_under, ImGui::GetIO().KeyCtrl);
  }
  if (ImGui::IsItemDeactivated()) editor.keep();

  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled({corner.x, middle - 0.7f * em}, {corner.x + size.x, middle + 0.7f * em}, k_track, 0.3f * em);
  const double step = round_step((range_.last - range_.first) * 4.5 * em / wide);
  for (double tick = std::ceil(range_.first / step) * step; tick <= range_.last; tick += step) {
    const float x = x_of(tick);
    draw.AddLine({x, middle - 0.7f * em}, {x, middle + 0.7f * em}, k_rule);
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%g s", std::round(tick * 1e6) * 1e-6);
    draw.AddText({x - 0.5f * ImGui::CalcTextSize(text.data()).x, corner.y}, k_rule_ink, text.data());
  }
  const EditState& now = editor.state();
  const auto current = editor.current_key();
  const float head = x_of(now.time);
  draw.AddLine({head, corner.y + 0.9f * em}, {head, corner.y + size.y}, k_current_key, 0.14f * em);
  for (std::size_t k = 0; k < now.keys.size(); ++k) {
    const EditKey& key = now.keys[k];
    const float x = x_of(key.time);
    const bool is_current = current && *current == static_cast<int>(k);
    const ImU32 colour = is_current ? k_current_key : key.airborne ? k_key_in_air : k_key;
    const float y = key.airborne ? middle - 0.35f * em : middle, r = is_current ? 1.25f * diamond : diamond;
    draw.AddQuadFilled({x - r, y}, {x, y - r}, {x + r, y}, {x, y + r}, colour);
  }
  if (ImGui::IsItemHovered() && !active)
    for (const EditKey& key : now.keys)
      if (std::abs(x_of(key.time) - mouse) <= diamond + 2)
        ImGui::SetTooltip("%.3f s %s%s", key.time, key.name.c_str(), key.airborne ? " (in the air)" : "");
}

void Timeline::draw(Editor& editor) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float margin = ImGui::GetFontSize(); // to the window's edge
  ImGui::SetNextWindowPos({margin, screen.y - margin}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({screen.x - 2 * margin, 0});
  ImGui::Begin("timeline", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  draw_row(editor);
  draw_track(editor);
  ImGui::End();
}

} // namespace tutu::app
