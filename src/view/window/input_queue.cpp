#include "src/view/window/input_queue.h"

#include <GLFW/glfw3.h>
#include <cctype>
#include <optional>

namespace tutu::app {
namespace {

bool is_down(GLFWwindow* window, int left, int right) {
  return glfwGetKey(window, left) == GLFW_PRESS || glfwGetKey(window, right) == GLFW_PRESS;
}

InputQueue& queue_of(GLFWwindow* window) { return *static_cast<InputQueue*>(glfwGetWindowUserPointer(window)); }

/// An event where the pointer was then.
InputEvent event_at_pointer(GLFWwindow* window, InputEvent::Kind kind) {
  InputEvent event;
  event.kind = kind;
  int width = 1, height = 1, pixels_wide = 1, pixels_high = 1;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &pixels_wide, &pixels_high);
  const InputQueue& queue = queue_of(window);
  event.x = (queue.pointer_x + 0.5) * pixels_wide / std::max(width, 1);
  event.y = (queue.pointer_y + 0.5) * pixels_high / std::max(height, 1);
  event.shift = is_down(window, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  return event;
}

void add(GLFWwindow* window, InputEvent event) { queue_of(window).add(std::move(event)); }

void note_shift(GLFWwindow* window) { add(window, event_at_pointer(window, InputEvent::Kind::move)); }

void note_move(GLFWwindow* window, double x, double y) {
  queue_of(window).pointer_x = x;
  queue_of(window).pointer_y = y;
  add(window, event_at_pointer(window, InputEvent::Kind::move));
}

void note_button(GLFWwindow* window, int button, int action, int) {
  InputEvent event =
      event_at_pointer(window, action == GLFW_PRESS ? InputEvent::Kind::press : InputEvent::Kind::release);
  if (button == GLFW_MOUSE_BUTTON_MIDDLE) event.button = PointerButton::middle;
  if (button == GLFW_MOUSE_BUTTON_RIGHT) event.button = PointerButton::right;
  add(window, std::move(event));
}

void note_wheel(GLFWwindow* window, double, double notches) {
  InputEvent event = event_at_pointer(window, InputEvent::Kind::wheel);
  event.notches = notches;
  add(window, std::move(event));
}

/// Letters as the keyboard's layout has them.
std::string name_of_key(int key, int scancode) {
  switch (key) {
  case GLFW_KEY_DELETE: return "Delete";
  case GLFW_KEY_UP: return "Up";
  case GLFW_KEY_DOWN: return "Down";
  case GLFW_KEY_LEFT: return "Left";
  case GLFW_KEY_RIGHT: return "Right";
  case GLFW_KEY_ESCAPE: return "Escape";
  case GLFW_KEY_ENTER:
  case GLFW_KEY_KP_ENTER: return "Enter";
  default: break;
  }
  const char* name = glfwGetKeyName(key, scancode);
  if (!name || name[0] == '\0' || name[1] != '\0') return "";
  return {static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])))};
}

void note_key(GLFWwindow* window, int key, int scancode, int action, int mods) {
  if (key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT) return note_shift(window);
  if (action == GLFW_RELEASE) return;
  std::string name = name_of_key(key, scancode);
  const bool with_control = (mods & GLFW_MOD_CONTROL) != 0;
  if (name.empty() || (name.size() == 1 && !with_control)) return; // that one writes: it comes as a character
  if (with_control) name = ((mods & GLFW_MOD_SHIFT) ? "Ctrl+Shift+" : "Ctrl+") + name;
  InputEvent event = event_at_pointer(window, InputEvent::Kind::key);
  event.keys = std::move(name);
  add(window, std::move(event));
}

void note_character(GLFWwindow* window, unsigned character) {
  InputEvent event = event_at_pointer(window, InputEvent::Kind::character);
  event.character = character;
  add(window, std::move(event));
}

} // namespace

InputQueue::InputQueue(GLFWwindow* window) {
  glfwSetWindowUserPointer(window, this);
  glfwGetCursorPos(window, &pointer_x, &pointer_y);
  glfwSetCursorPosCallback(window, note_move);
  glfwSetMouseButtonCallback(window, note_button);
  glfwSetScrollCallback(window, note_wheel);
  glfwSetKeyCallback(window, note_key);
  glfwSetCharCallback(window, note_character);
}

std::vector<InputEvent> InputQueue::take() {
  std::vector<InputEvent> taken;
  taken.swap(events_);
  return taken;
}

} // namespace tutu::app
