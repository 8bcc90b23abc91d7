// A window with OpenGL and panels in it: what every interactive command opens.
#pragma once

#include <string>

struct GLFWwindow;

namespace tutu::app {

/// GLFW from start to end. Throws std::runtime_error where there is no display.
class GlfwSession {
public:
  GlfwSession();
  ~GlfwSession();
  GlfwSession(const GlfwSession&) = delete;
  GlfwSession& operator=(const GlfwSession&) = delete;
};

/// A window with a current OpenGL 3.3 core context, within a GlfwSession. Throws std::runtime_error when that cannot be
/// had.
class Window {
public:
  Window(int width, int height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return handle_; }

private:
  GLFWwindow* handle_ = nullptr;
};

/// Dear ImGui in a window. Callbacks of the window that were set before still hear everything. A frame goes:
/// begin_frame, the panels, end_frame, the picture below them, draw.
class ImGuiSession {
public:
  explicit ImGuiSession(GLFWwindow* window);
  ~ImGuiSession();
  ImGuiSession(const ImGuiSession&) = delete;
  ImGuiSession& operator=(const ImGuiSession&) = delete;

  void begin_frame() const;
  void end_frame() const;
  void draw() const; ///< over what the bound framebuffer holds
};

/// Whether a window could be opened here.
bool display_available();

} // namespace tutu::app
