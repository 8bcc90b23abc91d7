#include "src/view/window/window.h"

#include "src/view/window/panel_style.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <stdexcept>
#include <string_view>

namespace tutu::app {
namespace {

std::string glfw_reason() {
  const char* reason = nullptr;
  glfwGetError(&reason);
  return reason ? std::string(": ") + reason : "";
}

void hint_context() {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
}

/// Smooth edges where a graphics card draws; a processor would need several times as long for them.
int affordable_samples() {
  hint_context();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* probe = glfwCreateWindow(16, 16, "", nullptr, nullptr);
  if (!probe) return 0;
  glfwMakeContextCurrent(probe);
  const std::string_view renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const bool software = renderer.find("llvmpipe") != renderer.npos || renderer.find("softpipe") != renderer.npos;
  glfwDestroyWindow(probe);
  return software ? 0 : 4;
}

} // namespace

GlfwSession::GlfwSession() {
  if (!glfwInit()) throw std::runtime_error("no window: there is no display to open it on" + glfw_reason());
}

GlfwSession::~GlfwSession() { glfwTerminate(); }

Window::Window(int width, int height, const std::string& title) {
  const int samples = affordable_samples();
  hint_context();
  glfwWindowHint(GLFW_STENCIL_BITS, 8);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHint(GLFW_SAMPLES, samples);
  handle_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!handle_ && samples > 0) {
    glfwWindowHint(GLFW_SAMPLES, 0);
    handle_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  }
  if (!handle_) throw std::runtime_error("no window: OpenGL 3.3 cannot be had on this display" + glfw_reason());
  glfwMakeContextCurrent(handle_);
  glfwSwapInterval(1);
}

Window::~Window() { glfwDestroyWindow(handle_); }

ImGuiSession::ImGuiSession(GLFWwindow* window) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  float scale = 1, ignored = 1;
  glfwGetWindowContentScale(window, &scale, &ignored);
  set_panel_style(scale);
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

ImGuiSession::~ImGuiSession() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void ImGuiSession::begin_frame() const {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void ImGuiSession::end_frame() const { ImGui::Render(); }

void ImGuiSession::draw() const { ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData()); }

bool display_available() {
  if (!glfwInit()) return false;
  glfwTerminate();
  return true;
}

} // namespace tutu::app
