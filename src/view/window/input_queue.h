// What pointer and keyboard did in a window, in order and where it happened: nothing is lost between two slow pictures.
#pragma once

#include <string>
#include <vector>

struct GLFWwindow;

namespace tutu::app {

enum class PointerButton { left, middle, right };

struct InputEvent {
  enum class Kind { move, press, release, wheel, key, character };
  Kind kind = Kind::move;
  double x = 0.0, y = 0.0; ///< px of the picture, the middle of the pixel under the pointer
  bool shift = false;
  PointerButton button = PointerButton::left; ///< of press and release
  double notches = 0.0;                       ///< of the wheel
  std::string keys = {};                      ///< "Delete", "Ctrl+Z", "Ctrl+Shift+Z": what writes nothing
  char32_t character = 0;
};

/// Takes the window's user pointer. Make it before ImGuiSession, which then hears everything too; it must outlive the
/// window's events.
class InputQueue {
public:
  explicit InputQueue(GLFWwindow* window);
  InputQueue(const InputQueue&) = delete;
  InputQueue& operator=(const InputQueue&) = delete;

  /// All events since the last call.
  std::vector<InputEvent> take();
  void add(InputEvent event) { events_.push_back(std::move(event)); }

  /// Where the last move went, in the window's own units: asked now, the system tells where the pointer is by now.
  double pointer_x = 0.0, pointer_y = 0.0;

private:
  std::vector<InputEvent> events_;
};

} // namespace tutu::app
