// The history of something that is edited: every step back to the start, and the gesture that may become one.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace tutu::app {

/// Of a gesture that ends where it began: a step all the same.
struct EveryGestureCounts {
  template <class State> bool operator()(const State&, const State&) const { return false; }
};

/// States are immutable once in the history; there is always one. `Same` tells which gestures have changed nothing.
template <class State, class Same = EveryGestureCounts> class EditHistory {
public:
  explicit EditHistory(State start) { history_.push_back(std::move(start)); }

  /// What is seen: the gesture's state while there is one, else the present step of the history.
  const State& state() const { return gesture_ ? *gesture_ : history_[present_]; }

  /// One step. A gesture is kept before it; steps that had been undone are gone.
  void change(State next) {
    keep();
    history_.erase(history_.begin() + static_cast<std::ptrdiff_t>(present_) + 1, history_.end());
    history_.push_back(std::move(next));
    ++present_;
  }

  /// A gesture (a drag, a scrub) shows any number of states and becomes one step when it is kept, or none when dropped
  /// or when it has changed nothing.
  void show(State next) { gesture_ = std::move(next); }
  void keep() {
    if (!gesture_) return;
    State next = std::move(*gesture_);
    gesture_.reset();
    if (!Same()(next, state())) change(std::move(next));
  }
  void drop() { gesture_.reset(); }
  bool in_gesture() const { return gesture_.has_value(); }

  /// False at the end of the history. A gesture is dropped.
  bool undo() {
    drop();
    if (present_ == 0) return false;
    --present_;
    return true;
  }
  bool redo() {
    drop();
    if (redo_depth() == 0) return false;
    ++present_;
    return true;
  }
  std::size_t undo_depth() const { return present_; }
  std::size_t redo_depth() const { return history_.size() - 1 - present_; }

protected:
  State& present() { return history_[present_]; }

private:
  std::vector<State> history_;
  std::size_t present_ = 0;
  std::optional<State> gesture_;
};

} // namespace tutu::app
