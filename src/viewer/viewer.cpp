#include "src/viewer/viewer.h"

#include "src/interrupt.h"
#include "src/render/renderer.h"
#include "src/viewer/pacing.h"
#include "src/viewer/panel.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tutu::app {
namespace {

constexpr int k_most_steps = 4;          // a drawn frame, to catch up
constexpr double k_step_budget = 0.05;   // s a drawn frame may spend on steps after the first
constexpr double k_longest_pause = 0.25; // s; a window that was dragged or hidden does not owe the time
constexpr double k_idle_wait = 0.05;     // s between pictures while nothing plays
constexpr float k_start_yaw = 0.35f, k_start_pitch = 0.08f;

std::string glfw_reason() {
  const char* reason = nullptr;
  glfwGetError(&reason);
  return reason ? std::string(": ") + reason : "";
}

/// GLFW from start to end.
struct GlfwSession {
  GlfwSession() {
    if (!glfwInit()) throw std::runtime_error("no window: there is no display to open it on" + glfw_reason());
  }
  ~GlfwSession() { glfwTerminate(); }
  GlfwSession(const GlfwSession&) = delete;
  GlfwSession& operator=(const GlfwSession&) = delete;
};

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

/// A window with a current OpenGL 3.3 core context.
struct Window {
  Window(int width, int height, const std::string& title) {
    const int samples = affordable_samples();
    hint_context();
    glfwWindowHint(GLFW_STENCIL_BITS, 8);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHint(GLFW_SAMPLES, samples);
    handle = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!handle && samples > 0) {
      glfwWindowHint(GLFW_SAMPLES, 0);
      handle = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    }
    if (!handle) throw std::runtime_error("no window: OpenGL 3.3 cannot be had on this display" + glfw_reason());
    glfwMakeContextCurrent(handle);
    glfwSwapInterval(1);
  }
  ~Window() { glfwDestroyWindow(handle); }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle = nullptr;
};

/// For keys that write nothing. By callback, since a key that is hit between two slow pictures is up again when asked.
void note_key(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  ViewerState& state = *static_cast<ViewerState*>(glfwGetWindowUserPointer(window));
  if (key == GLFW_KEY_HOME) state.restart = true;
  if (key == GLFW_KEY_ESCAPE) state.quit = true;
}

struct ImGuiSession {
  explicit ImGuiSession(GLFWwindow* window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    float scale = 1, ignored = 1;
    glfwGetWindowContentScale(window, &scale, &ignored);
    set_panel_style(scale);
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  ~ImGuiSession() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  ImGuiSession(const ImGuiSession&) = delete;
  ImGuiSession& operator=(const ImGuiSession&) = delete;
};

/// Looks at everything there is, from a little above.
OrbitCamera whole_view(const FrameView& view, float aspect) {
  Vec3f lo = Vec3f::Constant(1e30f), hi = Vec3f::Constant(-1e30f);
  const auto take = [&](const Vec3f& p) {
    if (!p.allFinite()) return;
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  };
  for (const SurfaceView& surface : view.surfaces)
    for (const Vec3f& p : surface.positions) take(p);
  for (const CapsuleView& capsule : view.capsules) {
    take(capsule.a);
    take(capsule.b);
  }
  if (lo.x() > hi.x()) return {};
  if (view.ground) lo.y() = std::min(lo.y(), view.ground_height);
  return frame_orbit(lo, hi, k_start_yaw, k_start_pitch, aspect);
}

/// Does what the user asked for and what the clock owes.
void advance(Player& player, ViewerState& state, Pacing& pacing, double elapsed) {
  if (state.restart) player.restart();
  if (state.seek_worst) {
    if (const auto worst = player.worst_time()) state.seek = *worst;
    state.playing = false;
  }
  state.seek_worst = false;
  if (state.seek) player.seek(*state.seek);
  if (state.restart || state.seek) pacing.forget();
  int due = 0;
  if (state.playing)
    due = pacing.steps_due(std::min(elapsed, k_longest_pause), state.time_scale, player.frame_seconds(), k_most_steps);
  else pacing.forget();
  if (state.step_once) {
    due = 1;
    state.playing = false;
  }
  state.restart = state.step_once = false;
  state.seek.reset();

  const double start = glfwGetTime();
  for (int i = 0; i < due; ++i) {
    if (i > 0 && glfwGetTime() - start > k_step_budget) break;
    if (player.time() + 0.5 * player.frame_seconds() > player.duration()) {
      if (state.loop) player.restart();
      else state.playing = false;
      break;
    }
    if (!player.step()) {
      state.playing = false;
      break;
    }
  }
}

} // namespace

bool display_available() {
  if (!glfwInit()) return false;
  glfwTerminate();
  return true;
}

int run_viewer(Player& player, const ViewerOptions& options) {
  const GlfwSession glfw;
  const Window window(options.width, options.height, "tutu - " + player.title());
  ViewerState state;
  glfwSetWindowUserPointer(window.handle, &state);
  glfwSetKeyCallback(window.handle, note_key); // before ImGui's, which then calls it
  const ImGuiSession imgui(window.handle);
  Renderer renderer;

  state.layers = options.layers;
  state.time_scale = static_cast<float>(options.time_scale);
  state.playing = options.playing;
  state.seek_worst = options.start_at_worst;
  state.loop = options.loop;
  state.reset_camera = true;
  Pacing pacing;
  SmoothTimes times;
  double last = glfwGetTime();
  for (int frame = 0; !glfwWindowShouldClose(window.handle) && !interrupted() && !state.quit; ++frame) {
    if (options.max_frames && frame >= *options.max_frames) break;
    if (state.playing || options.max_frames) glfwPollEvents();
    else glfwWaitEventsTimeout(k_idle_wait);
    const double now = glfwGetTime();
    advance(player, state, pacing, now - last);
    last = now;

    int width = 0, height = 0;
    glfwGetFramebufferSize(window.handle, &width, &height);
    if (width == 0 || height == 0) { // minimised
      glfwWaitEventsTimeout(k_idle_wait);
      continue;
    }
    const double draw_start = glfwGetTime();
    const FrameView view = player.view(state.layers);
    if (state.reset_camera) state.orbit = whole_view(view, static_cast<float>(width) / static_cast<float>(height));
    state.reset_camera = false;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    read_input(state);
    draw_panels(player, times, view.error_scale, state);
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    renderer.draw(view, state.orbit.camera(), width, height);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glFinish(); // so that the time below is the drawing's, not that of waiting for the display
    times.add(player.stage_times(), 1e3 * (glfwGetTime() - draw_start));
    glfwSwapBuffers(window.handle);
  }
  return 0;
}

} // namespace tutu::app
