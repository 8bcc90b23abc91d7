#include "src/viewer/viewer.h"

#include "src/interrupt.h"
#include "src/render/renderer.h"
#include "src/viewer/pacing.h"
#include "src/viewer/panel.h"
#include "src/viewer/window.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <string>

namespace tutu::app {
namespace {

constexpr int k_most_steps = 4;          // a drawn frame, to catch up
constexpr double k_step_budget = 0.05;   // s a drawn frame may spend on steps after the first
constexpr double k_longest_pause = 0.25; // s; a window that was dragged or hidden does not owe the time
constexpr double k_idle_wait = 0.05;     // s between pictures while nothing plays
constexpr float k_start_yaw = 0.35f, k_start_pitch = 0.08f;

/// For keys that write nothing. By callback, since a key that is hit between two slow pictures is up again when asked.
void note_key(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  ViewerState& state = *static_cast<ViewerState*>(glfwGetWindowUserPointer(window));
  if (key == GLFW_KEY_HOME) state.restart = true;
  if (key == GLFW_KEY_ESCAPE) state.quit = true;
}

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

int run_viewer(Player& player, const ViewerOptions& options) {
  const GlfwSession glfw;
  const Window window(options.width, options.height, "tutu - " + player.title());
  ViewerState state;
  glfwSetWindowUserPointer(window.handle(), &state);
  glfwSetKeyCallback(window.handle(), note_key); // before ImGui's, which then calls it
  const ImGuiSession imgui(window.handle());
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
  for (int frame = 0; !glfwWindowShouldClose(window.handle()) && !interrupted() && !state.quit; ++frame) {
    if (options.max_frames && frame >= *options.max_frames) break;
    if (state.playing || options.max_frames) glfwPollEvents();
    else glfwWaitEventsTimeout(k_idle_wait);
    const double now = glfwGetTime();
    advance(player, state, pacing, now - last);
    last = now;

    int width = 0, height = 0;
    glfwGetFramebufferSize(window.handle(), &width, &height);
    if (width == 0 || height == 0) { // minimised
      glfwWaitEventsTimeout(k_idle_wait);
      continue;
    }
    const double draw_start = glfwGetTime();
    const FrameView view = player.view(state.layers);
    if (state.reset_camera) state.orbit = whole_view(view, static_cast<float>(width) / static_cast<float>(height));
    state.reset_camera = false;
    imgui.begin_frame();
    read_input(state);
    draw_panels(player, times, view.error_scale, state);
    imgui.end_frame();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    renderer.draw(view, state.orbit.camera(), width, height);
    imgui.draw();
    glFinish(); // so that the time below is the drawing's, not that of waiting for the display
    times.add(player.stage_times(), 1e3 * (glfwGetTime() - draw_start));
    glfwSwapBuffers(window.handle());
  }
  return 0;
}

} // namespace tutu::app
