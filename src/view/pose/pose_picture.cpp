// The editor's window as a picture, drawn without a display.
#include "src/view/pose/pose_overlay.h"
#include "src/view/pose/pose_panels.h"
#include "src/view/pose/pose_view.h"
#include "src/view/pose/pose_window.h"
#include "src/view/pose/timeline.h"
#include "src/view/render/gl_context.h"
#include "src/view/render/gl_objects.h"
#include "src/view/render/offscreen.h"
#include "src/view/window/panel_style.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <stdexcept>

namespace tutu::app {
namespace {

constexpr int k_supersample = 2; // drawn larger, then averaged
constexpr int k_pictures = 3;    // until panels have found their size

/// ImGui in the current context, without a window.
class PanelSession {
public:
  PanelSession(int width, int height, float scale) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.MousePos = {-1, -1};
    set_panel_style(scale);
    set_pose_style();
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  ~PanelSession() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
  }
  PanelSession(const PanelSession&) = delete;
  PanelSession& operator=(const PanelSession&) = delete;
};

} // namespace

Image draw_pose_window(Editor& editor, int width, int height) {
  const int wide = width * k_supersample, high = height * k_supersample;
  const GlContext context;
  const Framebuffer framebuffer;
  const Renderbuffer colour, depth;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glBindRenderbuffer(GL_RENDERBUFFER, colour.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, wide, high);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour.name());
  glBindRenderbuffer(GL_RENDERBUFFER, depth.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, wide, high);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth.name());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the graphics driver cannot draw pictures of that size");

  const PanelSession panels(wide, high, k_supersample);
  Renderer renderer;
  PoseView view(editor.character());
  Timeline timeline;
  editor.resize(wide, high, k_supersample);
  for (int picture = 0; picture < k_pictures; ++picture) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    draw_pose_overlay(editor);
    timeline.draw(editor);
    draw_pose_panels(editor);
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    renderer.draw(view.frame(editor), editor.picture().camera, wide, high, k_supersample);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }
  std::vector<std::uint8_t> raw(std::size_t{4} * static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, wide, high, GL_RGBA, GL_UNSIGNED_BYTE, raw.data());
  Image image;
  image.width = width;
  image.height = height;
  reduce(raw, k_supersample, image);
  return image;
}

} // namespace tutu::app
