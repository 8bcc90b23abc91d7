#include "src/view/play/viewer_commands.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <cctype>

namespace tutu::app {
namespace {

void scale_time(ViewerState& state, float factor) {
  state.time_scale = std::clamp(state.time_scale * factor, 0.0625f, 4.0f);
}

constexpr std::array k_commands = {
    ViewerCommand{"File", "open ...", "F3", 0, GLFW_KEY_F3, [](ViewerState& s) { s.browse = true; }},
    ViewerCommand{"File", "picture of the window", "F12", 0, GLFW_KEY_F12, [](ViewerState& s) { s.screenshot = true; }},
    ViewerCommand{"File", "begin or end a film", "F9", 0, GLFW_KEY_F9, [](ViewerState& s) { s.toggle_film = true; }},
    ViewerCommand{"File", "quit", "Esc", 0, GLFW_KEY_ESCAPE, [](ViewerState& s) { s.quit = true; }},
    ViewerCommand{"Run", "play or pause", "Space", ' ', 0, [](ViewerState& s) { s.playing = !s.playing; }},
    ViewerCommand{"Run", "one frame further", ".", '.', 0, [](ViewerState& s) { ++s.steps; }},
    ViewerCommand{"Run", "one frame back", ",", ',', 0, [](ViewerState& s) { --s.steps; }},
    ViewerCommand{"Run", "ten frames further", "Right", 0, GLFW_KEY_RIGHT, [](ViewerState& s) { s.steps += 10; }},
    ViewerCommand{"Run", "ten frames back", "Left", 0, GLFW_KEY_LEFT, [](ViewerState& s) { s.steps -= 10; }},
    ViewerCommand{"Run", "back to the start", "Home", 0, GLFW_KEY_HOME, [](ViewerState& s) { s.rewind = true; }},
    ViewerCommand{"Run", "slower", "[", '[', 0, [](ViewerState& s) { scale_time(s, 0.5f); }},
    ViewerCommand{"Run", "faster", "]", ']', 0, [](ViewerState& s) { scale_time(s, 2.0f); }},
    ViewerCommand{"Run", "loop or stop at the end", "L", 'l', 0, [](ViewerState& s) { s.loop = !s.loop; }},
    ViewerCommand{"Run", "where the skin leaves the proxies most", "J", 'j', 0,
                  [](ViewerState& s) { s.seek_worst = true; }},
    ViewerCommand{"Edit", "edit the proxies, or play on", "M", 'm', 0, [](ViewerState& s) { s.toggle_mode = true; }},
    ViewerCommand{"View", "camera as at the start", "R", 'r', 0, [](ViewerState& s) { s.reset_camera = true; }},
    ViewerCommand{"View", "panels", "Tab", 0, GLFW_KEY_TAB, [](ViewerState& s) { s.panels = !s.panels; }},
    ViewerCommand{"View", "help", "?", '?', 0, [](ViewerState& s) { s.help = !s.help; }},
};

} // namespace

std::span<const ViewerCommand> viewer_commands() { return k_commands; }

void apply_character(unsigned character, ViewerState& state) {
  if (character > 127) return;
  const char lower = static_cast<char>(std::tolower(static_cast<int>(character)));
  for (const ViewerCommand& command : k_commands)
    if (command.character != 0 && command.character == lower) command.act(state);
  for (const LayerInfo& layer : k_layers)
    if (layer.key == lower) state.layers.*layer.member = !(state.layers.*layer.member);
}

void apply_key(int key, ViewerState& state) {
  for (const ViewerCommand& command : k_commands)
    if (command.key != 0 && command.key == key) command.act(state);
}

} // namespace tutu::app
