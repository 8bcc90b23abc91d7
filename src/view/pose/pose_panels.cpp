#include "src/view/pose/pose_panels.h"

#include <array>
#include <cstring>
#include <imgui.h>

namespace tutu::app {
namespace {

const ImVec4 k_accent = {0.62f, 0.10f, 0.22f, 1};
constexpr ImGuiWindowFlags k_panel_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                                           ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// Between panels and the window's edge, px.
float margin() { return ImGui::GetFontSize(); }

struct MouseLine {
  const char *what, *does;
};
constexpr std::array<MouseLine, 7> k_mouse = {{{"Shift + drag a joint", "move it; the root moves the whole body"},
                                               {"Shift + drag the ring", "twist the joint about its bone"},
                                               {"drag", "turn the camera"},
                                               {"middle or right drag", "move the camera aside"},
                                               {"wheel", "nearer, further"},
                                               {"drag a key", "move it in time"},
                                               {"Ctrl + drag a key", "move it and all later ones"}}};

bool can_run(const Editor& editor, EditorCommand command) {
  if (command == EditorCommand::undo) return editor.document().undo_depth() > 0;
  if (command == EditorCommand::redo) return editor.document().redo_depth() > 0;
  return true;
}

void draw_interpolation(Editor& editor) {
  if (!ImGui::BeginMenu("Between keys")) return;
  for (std::size_t i = 0; i < rig::k_interpolation_names.size(); ++i) {
    const auto one = static_cast<rig::Interpolation>(i);
    if (ImGui::MenuItem(rig::k_interpolation_names[i].data(), nullptr, editor.state().interpolation == one))
      editor.set_interpolation(one);
  }
  ImGui::EndMenu();
}

void draw_menus(Editor& editor) {
  if (!ImGui::BeginMainMenuBar()) return;
  const auto table = command_table();
  for (std::size_t first = 0; first < table.size();) {
    const char* menu = table[first].menu;
    std::size_t last = first;
    while (last < table.size() && std::strcmp(table[last].menu, menu) == 0) ++last;
    if (ImGui::BeginMenu(menu)) {
      for (std::size_t i = first; i < last; ++i)
        if (ImGui::MenuItem(table[i].label, table[i].keys, editor.is_on(table[i].command),
                            can_run(editor, table[i].command)))
          editor.run(table[i].command);
      if (std::strcmp(menu, "Keys") == 0) draw_interpolation(editor);
      ImGui::EndMenu();
    }
    first = last;
  }
  const std::string title =
      editor.clip_file().filename().string() + (editor.document().dirty() ? "  (not written)" : "");
  ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(title.c_str()).x - 1.5f * ImGui::GetFontSize());
  ImGui::TextUnformatted(title.c_str());
  ImGui::EndMainMenuBar();
}

void toggle(Editor& editor, EditorCommand command) {
  bool on = editor.is_on(command);
  if (ImGui::Checkbox(entry_of(command).label, &on)) editor.run(command);
  ImGui::SameLine(ImGui::GetFontSize() * 19);
  ImGui::TextDisabled("%s", entry_of(command).keys);
}

void draw_joint(Editor& editor) {
  ImGui::SetNextWindowPos({margin(), ImGui::GetFrameHeight() + margin()});
  ImGui::Begin("joint", nullptr, k_panel_flags);
  if (const auto joint = editor.selected()) {
    ImGui::TextColored(k_accent, "%s", std::string(rig::bare_joint_name(editor.skeleton().names[*joint])).c_str());
    const Quat& q = editor.state().pose[*joint].rotation;
    ImGui::TextDisabled("x %+.3f  y %+.3f  z %+.3f  w %+.3f", q.x(), q.y(), q.z(), q.w());
  } else {
    ImGui::TextColored(k_accent, "Hold Shift and drag a joint");
    ImGui::TextDisabled("? shows all keys");
  }
  ImGui::Separator();
  for (const EditorCommand command :
       {EditorCommand::toggle_ik, EditorCommand::toggle_one_child, EditorCommand::toggle_pin})
    toggle(editor, command);
  ImGui::Separator();
  ImGui::TextDisabled("%zu steps to undo, %zu to redo", editor.document().undo_depth(), editor.document().redo_depth());
  ImGui::End();
}

void draw_message(const Editor& editor) {
  if (editor.message().empty()) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, ImGui::GetFrameHeight() + margin()}, ImGuiCond_Always, {0.5f, 0});
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin("message", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  ImGui::TextUnformatted(editor.message().c_str());
  ImGui::End();
}

void draw_help(const Editor& editor) {
  if (!editor.view().help) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(0.97f);
  ImGui::Begin("help", nullptr, k_panel_flags | ImGuiWindowFlags_NoInputs);
  const auto line = [&](const char* keys, const char* what, float column) {
    ImGui::TextColored(k_accent, "%s", keys);
    ImGui::SameLine(column);
    ImGui::TextUnformatted(what);
  };
  ImGui::BeginGroup();
  for (const MouseLine& mouse : k_mouse) line(mouse.what, mouse.does, 13 * em);
  ImGui::EndGroup();
  ImGui::Separator();
  // Two columns of keys: one would be higher than a small window.
  const auto table = command_table();
  const std::size_t half = (table.size() + 1) / 2;
  for (std::size_t i = 0; i < half; ++i) {
    line(table[i].keys, table[i].label, 5 * em);
    if (i + half >= table.size()) continue;
    ImGui::SameLine(29 * em);
    ImGui::TextColored(k_accent, "%s", table[i + half].keys);
    ImGui::SameLine(34 * em);
    ImGui::TextUnformatted(table[i + half].label);
  }
  ImGui::End();
}

void draw_question(Editor& editor) {
  const EditorQuestion question = editor.question();
  if (question == EditorQuestion::none) return;
  const bool found = question == EditorQuestion::take_up_autosave;
  const char* title = found ? "Unsaved work was found" : "Not everything is written";
  ImGui::OpenPopup(title);
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.4f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove)) return;
  if (found) ImGui::Text("An earlier session ended before it wrote\n%s.", editor.clip_file().filename().c_str());
  else ImGui::Text("%s lacks your last changes.", editor.clip_file().filename().c_str());
  ImGui::Dummy({0, 0.4f * ImGui::GetFontSize()});
  const auto button = [&](const char* label, Answer answer) {
    if (ImGui::Button(label)) {
      editor.answer(answer);
      ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
  };
  button(found ? "take it up (Enter)" : "write and leave (Enter)", Answer::yes);
  button(found ? "throw it away" : "leave without", Answer::no);
  if (!found) button("stay (Esc)", Answer::cancel);
  ImGui::EndPopup();
}

} // namespace

void set_pose_style() {
  ImGuiStyle& style = ImGui::GetStyle();
  style.Colors[ImGuiCol_TextDisabled] = {0.33f, 0.37f, 0.45f, 1};
  style.Colors[ImGuiCol_MenuBarBg] = {1, 1, 1, 0.85f};
  style.Colors[ImGuiCol_PopupBg] = {1, 1, 1, 1};
  style.Colors[ImGuiCol_TitleBg] = style.Colors[ImGuiCol_TitleBgActive] = {0.93f, 0.94f, 0.96f, 1};
  style.Colors[ImGuiCol_ModalWindowDimBg] = {0.2f, 0.25f, 0.35f, 0.35f};
}

void draw_pose_panels(Editor& editor) {
  draw_menus(editor);
  draw_joint(editor);
  draw_message(editor);
  draw_help(editor);
  draw_question(editor);
}

} // namespace tutu::app
