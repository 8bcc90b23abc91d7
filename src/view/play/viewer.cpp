#include "src/view/play/viewer.h"

#include "src/base/interrupt.h"
#include "src/view/play/panel.h"
#include "src/view/render/renderer.h"
#include "src/view/window/file_dialog.h"
#include "src/view/window/pacing.h"
#include "src/view/window/window.h"
#include "src/view/window/window_pictures.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <array>
#include <cctype>
#include <cmath>
#include <imgui.h>
#include <string>
#include <string_view>
#include <utility>

namespace tutu::app {
namespace {

constexpr double k_longest_pause = 0.25; // s; a window that was dragged or hidden does not owe the time
constexpr int k_most_steps = 60;         // a drawn frame, to catch up: all that the pause can owe
constexpr double k_idle_wait = 0.05;     // s between pictures while nothing plays
constexpr float k_start_yaw = 0.35f, k_start_pitch = 0.08f;
constexpr char32_t k_mode_key = 'm';
constexpr float k_click = 8; // px around the pointer that a click finds

/// What the importer and the scene reader take.
constexpr std::array<std::string_view, 6> k_openable = {".json", ".dae", ".gltf", ".glb", ".fbx", ".x"};

/// The events, which a mode takes in order, and what the keys did to the state.
struct Heard : InputQueue {
  explicit Heard(GLFWwindow* window) : InputQueue(window) {}
  /// Without the character: nothing. Whether it was there.
  bool keep_what_follows(char32_t character) {
    const std::vector<InputEvent> events = take();
    bool follows = false;
    for (const InputEvent& event : events) {
      if (follows) add(event);
      follows = follows || (event.kind == InputEvent::Kind::character && event.character == character);
    }
    return follows;
  }
  ViewerState state;
  GLFWkeyfun events_key = nullptr; ///< the queue's own
};

Heard& heard_in(GLFWwindow* window) {
  return static_cast<Heard&>(*static_cast<InputQueue*>(glfwGetWindowUserPointer(window)));
}
ViewerState& state_of(GLFWwindow* window) { return heard_in(window).state; }

/// For keys that write nothing. By callback, since a key that is hit between two slow pictures is up again when asked.
void note_key(GLFWwindow* window, int key, int scancode, int action, int mods) {
  heard_in(window).events_key(window, key, scancode, action, mods);
  const bool goes_on = key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT; // as long as it is held
  if (action == GLFW_PRESS || (action == GLFW_REPEAT && goes_on)) apply_key(key, state_of(window));
}

void note_drop(GLFWwindow* window, int count, const char** paths) {
  if (count > 0) state_of(window).open = paths[0];
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

/// Does what the user asked for and what the clock owes. `filming`: one frame a picture, however long it takes.
void advance(Player& player, ViewerState& state, Pacing& pacing, double elapsed, bool filming) {
  if (state.rewind) player.rewind();
  if (state.seek_worst) {
    if (const auto worst = player.worst_time()) state.seek = *worst;
    state.playing = false;
  }
  if (state.seek) player.seek(*state.seek);
  if (state.rewind || state.seek) pacing.forget();
  if (state.steps != 0) {
    player.go(state.steps);
    state.playing = false;
  }
  state.rewind = state.seek_worst = false;
  state.seek.reset();
  state.steps = 0;

  player.go(0);                            // what was simulated since the last picture
  if (!state.playing || player.behind()) { // what cannot be simulated in time is not owed either
    pacing.forget();
  } else if (player.at_end()) {
    if (state.loop && player.message().empty()) player.rewind();
    else state.playing = false;
  } else {
    const int due =
        pacing.steps_due(std::min(elapsed, k_longest_pause), state.time_scale, player.frame_seconds(), k_most_steps);
    if (filming) player.go(1);
    else if (due > 0) player.go(due);
  }
}

/// The part of the window that one of `count` views has: pixels from the left, and how many.
std::pair<int, int> part_of(int width, std::size_t k, std::size_t count) {
  const int each = width / static_cast<int>(count);
  return {static_cast<int>(k) * each, each};
}

/// Letters, digits, dots and dashes only.
std::string file_stem(std::string title) {
  for (char& c : title)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_') c = '-';
  return title;
}

void pick(Player& player, const ViewerState& state, GLFWwindow* window, std::size_t views) {
  int width = 0, height = 0; // of the window, in which the pointer is told
  glfwGetWindowSize(window, &width, &height);
  const int each = part_of(width, 0, views).second;
  const Eigen::Vector2f pixel(std::fmod(state.click->x(), static_cast<float>(each)), state.click->y());
  const Camera camera = state.orbit.camera();
  const float metres_per_pixel = 2 * std::tan(0.5f * camera.vertical_fov) / static_cast<float>(height);
  player.pick({camera.eye, ray_through(camera, each, height, pixel), k_click * metres_per_pixel});
}

/// Whether the window is to close. A mode with work that is not saved asks before.
bool wants_to_end(GLFWwindow* window, WindowMode* mode, ViewerState& state) {
  if (mode && mode->is_closing()) {
    if (!state.open) state.open = state.open_then;
    return true;
  }
  if (!glfwWindowShouldClose(window) && !state.quit && !state.open) return false;
  if (!mode || mode->may_close()) return true;
  glfwSetWindowShouldClose(window, GLFW_FALSE);
  state.quit = false;
  state.open_then = std::exchange(state.open, std::nullopt);
  return false;
}

void switch_mode(WindowMode* mode, ViewerState& state) {
  if (state.toggle_mode && mode && !mode->asks()) mode->toggle();
  else if (state.toggle_mode && !mode) state.note = "two scenes side by side are not edited";
  state.toggle_mode = false;
  state.in_mode = mode && mode->on();
}

/// The events since the last picture, then what the mode shows.
void let_mode_work(WindowMode& mode, Heard& heard, GLFWwindow* window, std::vector<FrameView>& views) {
  int width = 0, height = 0;
  float scale = 1, ignored = 1;
  glfwGetFramebufferSize(window, &width, &height);
  glfwGetWindowContentScale(window, &scale, &ignored);
  const ImGuiIO& io = ImGui::GetIO();
  if (mode.asks()) heard.state.quit = false; // Esc takes the question back
  for (const InputEvent& event : heard.take()) {
    mode.set_picture(heard.state.orbit.camera(), width, height, scale);
    const bool by_key = event.kind == InputEvent::Kind::key || event.kind == InputEvent::Kind::character;
    mode.take(event, by_key ? io.WantTextInput : io.WantCaptureMouse, heard.state.orbit);
  }
  mode.set_picture(heard.state.orbit.camera(), width, height, scale);
  mode.show(views);
}

} // namespace

ViewerEnd run_viewer(Player& player, const ViewerOptions& options) {
  const GlfwSession glfw;
  const Window window(options.width, options.height, "tutu - " + player.title());
  Heard heard(window.handle());
  ViewerState& state = heard.state;
  heard.events_key = glfwSetKeyCallback(window.handle(), note_key); // before ImGui's, which then calls it
  glfwSetDropCallback(window.handle(), note_drop);
  const ImGuiSession imgui(window.handle());
  Renderer renderer;
  WindowPictures pictures(options.pictures, file_stem(player.title()));

  FileDialog dialog(options.browse, k_openable);

  state.layers = options.layers;
  state.time_scale = static_cast<float>(options.time_scale);
  state.playing = options.playing;
  state.seek_worst = options.start_at_worst;
  state.loop = options.loop;
  state.note = options.message;
  state.reset_camera = true;
  Pacing pacing;
  SmoothTimes times;
  int drawn = 0;
  double last = glfwGetTime(), filmed = -1;
  for (int frame = 0; !interrupted() && !wants_to_end(window.handle(), options.mode, state); ++frame) {
    if (options.max_frames && frame >= *options.max_frames) break;
    if (options.close_at_end && frame > 0 && player.at_end() && !state.in_mode) break;
    if (state.playing || player.behind() || options.max_frames) glfwPollEvents();
    else glfwWaitEventsTimeout(k_idle_wait);
    int width = 0, height = 0;
    glfwGetFramebufferSize(window.handle(), &width, &height);
    const bool minimised = width == 0 || height == 0;
    // What was typed counts before anything is drawn: a picture that is asked for shows what the keys before it did.
    if (!minimised) {
      imgui.begin_frame();
      const bool others_mouse = state.in_mode || heard.keep_what_follows(k_mode_key);
      read_input(state, !others_mouse);
    }
    const double now = glfwGetTime();
    if (state.in_mode) state.playing = false;
    advance(player, state, pacing, now - last, pictures.filming());
    last = now;
    if (minimised) {
      glfwWaitEventsTimeout(k_idle_wait);
      continue;
    }
    const double draw_start = glfwGetTime();
    std::vector<FrameView> views = player.views(state.in_mode ? options.mode->layers(state.layers) : state.layers);
    if (state.reset_camera) {
      const auto [left, each] = part_of(width, 0, views.size());
      state.orbit = whole_view(views.front(), static_cast<float>(each) / static_cast<float>(height));
    }
    state.reset_camera = false;
    if (state.in_mode) let_mode_work(*options.mode, heard, window.handle(), views);
    if (state.click) pick(player, state, window.handle(), views.size());
    state.click.reset();
    draw_panels(player, times, views, options.recent, state);
    if (state.in_mode) options.mode->draw_panels(state.panels ? ImGui::GetFrameHeight() : 0.0f, state.panels);
    if (state.browse) dialog.open();
    state.browse = false;
    if (dialog.is_open() && state.quit) { // Esc leaves the dialog first
      dialog.close();
      state.quit = false;
    }
    if (const auto chosen = dialog.draw()) state.open = chosen->string();
    imgui.end_frame();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    for (std::size_t k = 0; k < views.size(); ++k) {
      const auto [left, each] = part_of(width, k, views.size());
      renderer.draw(views[k], state.orbit.camera(), each, height, 1.0f, left);
    }
    glViewport(0, 0, width, height);
    imgui.draw();
    glFinish(); // so that the time below is the drawing's, not that of waiting for the display
    times.add(player.stage_times(), 1e3 * (glfwGetTime() - draw_start));
    ++drawn;
    if (state.screenshot && !player.behind()) {
      const int index = static_cast<int>(std::lround(player.time() / player.frame_seconds()));
      state.note = pictures.screenshot(read_window(width, height), index);
      state.screenshot = false;
    }
    if (state.toggle_film) state.note = pictures.toggle_film(width, height, 1.0 / player.frame_seconds());
    state.toggle_film = false;
    if (pictures.filming() && player.time() != filmed) state.note = pictures.add(read_window(width, height));
    filmed = player.time();
    glfwSwapBuffers(window.handle());
    switch_mode(options.mode, state); // before the window may close
  }
  if (pictures.filming()) pictures.toggle_film(0, 0, 1.0);
  return {state.layers, state.playing, state.time_scale, drawn, times.draw(), state.open};
}

} // namespace tutu::app
