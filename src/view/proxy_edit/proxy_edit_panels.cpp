// The panel, the handles and the questions of ProxyEditMode.
#include "src/view/proxy_edit/proxy_edit_mode.h"

#include <cstdio>
#include <imgui.h>

namespace tutu::app {
namespace {

const ImVec4 k_accent = {0.62f, 0.10f, 0.22f, 1};
constexpr ImU32 k_outline = IM_COL32(20, 30, 50, 230), k_move = IM_COL32(255, 255, 255, 255),
                k_end = IM_COL32(240, 228, 66, 255), k_radius = IM_COL32(0, 158, 115, 255),
                k_held = IM_COL32(213, 94, 0, 255); // [Okabe and Ito 2008]
constexpr ImGuiWindowFlags k_panel_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                                           ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

double mm(double metres) { return 1e3 * metres; }

void draw_handles(const ProxyEditor& editor, float pixel_scale) {
  const std::vector<Handle> handles = editor.handles();
  if (handles.empty()) return;
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  const Picture& picture = editor.picture();
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const auto seen = [&](const Vec3& place) -> std::optional<ImVec2> {
    const auto pixel = project(picture.camera, picture.width, picture.height, place.cast<float>());
    if (!pixel) return std::nullopt;
    return ImVec2{pixel->x() * screen.x / static_cast<float>(picture.width),
                  pixel->y() * screen.y / static_cast<float>(picture.height)};
  };
  const auto line = [&](const Vec3& from, const Vec3& to, ImU32 colour) {
    const auto a = seen(from), b = seen(to);
    if (a && b) draw.AddLine(*a, *b, colour, 2.0f * pixel_scale);
  };
  const proxies::Capsule shape = posed(*editor.selected(), editor.pose().world_from_joint);
  line(shape.a, shape.b, k_outline);
  for (const Handle& handle : handles) {
    if (handle.kind == HandleKind::radius_a) line(shape.a, handle.place, k_radius);
    if (handle.kind == HandleKind::radius_b) line(shape.b, handle.place, k_radius);
  }
  for (const Handle& handle : handles) {
    const auto place = seen(handle.place);
    if (!place) continue;
    const bool is_end = handle.kind == HandleKind::end_a || handle.kind == HandleKind::end_b;
    const ImU32 colour = editor.held() == handle.kind      ? k_held
                         : handle.kind == HandleKind::move ? k_move
                         : is_end                          ? k_end
                                                           : k_radius;
    const float size = 6.0f * pixel_scale;
    if (is_end || handle.kind == HandleKind::move) { // ends and middle are round, radii square
      draw.AddCircleFilled(*place, size + 1.5f, k_outline);
      draw.AddCircleFilled(*place, size, colour);
    } else {
      const float side = 0.8f * size;
      draw.AddRectFilled({place->x - side - 1.5f, place->y - side - 1.5f},
                         {place->x + side + 1.5f, place->y + side + 1.5f}, k_outline);
      draw.AddRectFilled({place->x - side, place->y - side}, {place->x + side, place->y + side}, colour);
    }
  }
}

void draw_figures(ProxyEditor& editor) {
  const ProxyMeasure::Result& figures = editor.figures();
  if (!ImGui::BeginTable("figures", 4, ImGuiTableFlags_SizingFixedFit)) return;
  const auto cell = [](const char* text) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text);
  };
  for (const char* head : {"at this pose, mm", "p95", "max", "rms"}) cell(head);
  const auto number = [&](double metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%7.2f", mm(metres));
    cell(text);
  };
  const auto rows = [&](const char* whose, const ProxyFigures& of) {
    for (const auto& [side, error] : {std::pair{"skin out of", of.under}, std::pair{"skin deep in", of.over}}) {
      char name[64];
      std::snprintf(name, sizeof name, "%s %s", side, whose);
      cell(name);
      for (const double value : {error.p95, error.max, error.rms}) number(value);
    }
  };
  if (editor.selected() && editor.selected()->enabled) rows("this one", figures.one);
  rows("all", figures.whole);
  ImGui::EndTable();
}

void draw_commands(ProxyEditor& editor) {
  for (const ProxyCommandEntry& entry : proxy_command_table()) {
    const bool can = editor.can_run(entry.command);
    ImGui::BeginDisabled(!can);
    if (ImGui::Button(entry.label, {ImGui::GetFontSize() * 15, 0})) editor.run(entry.command);
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::TextDisabled("%s", entry.keys);
  }
}

void draw_joints(ProxyEditor& editor) {
  const std::vector<std::string>& names = editor.skeleton().names;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 15);
  if (!ImGui::BeginCombo("joint", names[editor.joint()].c_str())) return;
  for (int j = 0; j < editor.skeleton().joint_count(); ++j)
    if (ImGui::Selectable(names[j].c_str(), j == editor.joint())) editor.choose_joint(j);
  ImGui::EndCombo();
}

bool begin_question(const char* title) {
  ImGui::OpenPopup(title);
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.4f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  return ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
}

void ask_to_leave(ProxyEditor& editor) {
  if (!begin_question("Proxies are not saved")) return;
  ImGui::TextUnformatted("The file lacks your last changes.");
  if (ImGui::Button("save and leave (Enter)")) editor.answer_leave(true);
  ImGui::SameLine();
  if (ImGui::Button("leave without")) editor.answer_leave(false);
  ImGui::SameLine();
  if (ImGui::Button("stay (Esc)")) editor.cancel_question();
  ImGui::EndPopup();
}

void ask_for_file(ProxyEditor& editor, std::span<char> name, bool& offered) {
  if (!begin_question("Save the proxies as")) return;
  if (!offered) {
    std::snprintf(name.data(), name.size(), "%s", editor.file().c_str());
    ImGui::SetKeyboardFocusHere();
    offered = true;
  }
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 36);
  const bool enter = ImGui::InputText("##file", name.data(), name.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  if (enter) {
    editor.answer_save_as(name.data());
    ImGui::SetKeyboardFocusHere(-1); // where it failed, another name can be typed at once
  }
  if (ImGui::Button("save (Enter)")) editor.answer_save_as(name.data());
  ImGui::SameLine();
  if (ImGui::Button("stay (Esc)")) editor.cancel_question();
  ImGui::EndPopup();
}

} // namespace

void ProxyEditMode::draw_panel(float top) {
  const float margin = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({margin, top + margin});
  ImGui::Begin("proxies", nullptr, k_panel_flags);
  if (const proxies::Proxy* proxy = editor_.selected()) {
    ImGui::TextColored(k_accent, "%s", proxy->name.c_str());
    if (proxy->taper == 0.0) ImGui::Text("radius %.2f mm", mm(proxy->radius));
    else ImGui::Text("radii %.2f and %.2f mm", mm(proxy->radius), mm(proxy->radius + proxy->taper));
    ImGui::TextDisabled("drag round handles to move, square ones to resize\nShift: one end's radius alone");
  } else {
    ImGui::TextColored(k_accent, "Click a proxy to edit it");
    ImGui::TextDisabled("drag turns, Shift + drag moves the camera");
  }
  ImGui::Separator();
  draw_figures(editor_);
  ImGui::Separator();
  ImGui::Checkbox("error on the skin", &heat_);
  ImGui::SameLine();
  ImGui::Checkbox("cloth", &cloth_);
  ImGui::SameLine();
  ImGui::Checkbox("other proxies", &others_);
  draw_joints(editor_);
  draw_commands(editor_);
  ImGui::TextDisabled("%zu to undo, %zu to redo%s", editor_.document().undo_depth(), editor_.document().redo_depth(),
                      editor_.document().dirty() ? ", not saved" : "");
  ImGui::TextDisabled("M plays on with these proxies");
  for (const std::string& text : {editor_.message(), note_})
    if (!text.empty()) {
      ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
      ImGui::TextColored(k_accent, "%s", text.c_str());
      ImGui::PopTextWrapPos();
    }
  ImGui::End();
}

void ProxyEditMode::draw_panels(float top, bool panels) {
  draw_handles(editor_, pixel_scale_);
  if (panels) draw_panel(top);
  if (editor_.question() == ProxyQuestion::leave_unsaved) ask_to_leave(editor_);
  if (editor_.question() == ProxyQuestion::save_as) ask_for_file(editor_, name_, name_offered_);
  else name_offered_ = false;
}

} // namespace tutu::app
