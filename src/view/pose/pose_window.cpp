#include "src/view/pose/pose_window.h"

#include "rig/io/file_io.h"
#include "src/base/json_text.h"
#include "src/view/pose/pose_overlay.h"
#include "src/view/pose/pose_panels.h"
#include "src/view/pose/pose_view.h"
#include "src/view/pose/timeline.h"
#include "src/view/render/renderer.h"
#include "src/view/window/input_queue.h"
#include "src/view/window/window.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

constexpr double k_idle_wait = 0.5; // s between pictures while nothing happens
constexpr int k_settling = 3;       // pictures after the last event: panels find their size in the next one

void take_key(Editor& editor, const std::string& keys) {
  if (editor.question() != EditorQuestion::none) {
    if (keys == "Enter") editor.answer(Answer::yes);
    if (keys == "Escape" && editor.question() == EditorQuestion::leave_unsaved) editor.answer(Answer::cancel);
  } else if (keys == "Escape") {
    if (editor.view().help) editor.run(EditorCommand::help);
  } else if (keys == "Ctrl+Shift+Z") {
    editor.run(EditorCommand::redo);
  } else if (keys == "Ctrl+S") {
    editor.run(EditorCommand::write_files);
  } else if (const auto command = command_of_key(keys)) {
    editor.run(*command);
  }
}

void take_event(Editor& editor, const InputEvent& event) {
  const ImGuiIO& io = ImGui::GetIO();
  switch (event.kind) {
  case InputEvent::Kind::move: editor.point(event.x, event.y, event.shift && !io.WantCaptureMouse); break;
  case InputEvent::Kind::press:
    if (io.WantCaptureMouse) break;
    editor.point(event.x, event.y, event.shift);
    editor.press(event.button);
    break;
  case InputEvent::Kind::release:
    editor.point(event.x, event.y, event.shift && !io.WantCaptureMouse);
    editor.release();
    break;
  case InputEvent::Kind::wheel:
    if (!io.WantCaptureMouse) editor.wheel(event.notches);
    break;
  case InputEvent::Kind::key:
    if (!io.WantTextInput) take_key(editor, event.keys);
    break;
  case InputEvent::Kind::character:
    if (const auto command = command_of_character(event.character); command && !io.WantTextInput) editor.run(*command);
    break;
  }
}

void draw_panels(Editor& editor, Timeline& timeline) {
  draw_pose_overlay(editor);
  timeline.draw(editor);
  draw_pose_panels(editor);
}

} // namespace

void run_pose_window(Editor& editor, const PoseWindowOptions& options) {
  const GlfwSession glfw;
  const Window window(options.width, options.height, "tutu pose - " + editor.clip_file().filename().string());
  InputQueue input(window.handle());
  const ImGuiSession imgui(window.handle());
  set_pose_style();
  Renderer renderer;
  PoseView view(editor.character());
  Timeline timeline;
  std::string written_state;
  int settling = k_settling;
  for (bool first = true; !editor.done();) {
    if (settling > 0) glfwPollEvents();
    else glfwWaitEventsTimeout(k_idle_wait);
    --settling;
    int width = 0, height = 0;
    float scale = 1, ignored = 1;
    glfwGetFramebufferSize(window.handle(), &width, &height);
    glfwGetWindowContentScale(window.handle(), &scale, &ignored);
    if (width == 0 || height == 0) continue; // minimised
    editor.resize(width, height, scale);
    imgui.begin_frame(); // before the events: now it knows which of them are the panels'
    for (const InputEvent& event : input.take()) {
      take_event(editor, event);
      settling = k_settling;
    }
    if (glfwWindowShouldClose(window.handle())) {
      glfwSetWindowShouldClose(window.handle(), GLFW_FALSE);
      editor.ask_to_leave();
      settling = k_settling;
    }
    draw_panels(editor, timeline);
    imgui.end_frame();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    renderer.draw(view.frame(editor), editor.picture().camera, width, height);
    imgui.draw();
    glfwSwapBuffers(window.handle());
    if (first) {
      fmt::print("ready\n");
      std::fflush(stdout);
      first = false;
    }
    if (options.state_file.empty()) continue;
    if (std::string state = json_text(editor.json()); state != written_state) {
      write_file(options.state_file, state);
      written_state = std::move(state);
    }
  }
}

} // namespace tutu::app
