// The work on a clip with its history: every step back to the start, and what of it is in the files.
#pragma once

#include "src/pose/edit_state.h"

namespace tutu::app {

/// States are immutable once in the history; there is always one.
class EditDocument {
public:
  /// `start` counts as written.
  explicit EditDocument(EditState start);

  /// What is seen: the gesture's state while there is one, else the present step of the history.
  const EditState& state() const { return gesture_ ? *gesture_ : history_[present_]; }

  /// One step. A gesture is kept before it; steps that had been undone are gone.
  void change(EditState next);

  /// A gesture (a drag, a scrub) shows any number of states and becomes one step when it is kept, or none when dropped.
  void show(EditState next) { gesture_ = std::move(next); }
  void keep();
  void drop() { gesture_.reset(); }
  bool in_gesture() const { return gesture_.has_value(); }

  /// False at the end of the history. A gesture is dropped.
  bool undo();
  bool redo();
  std::size_t undo_depth() const { return present_; }
  std::size_t redo_depth() const { return history_.size() - 1 - present_; }

  /// Is there anything that the files do not hold: another clip, or a loose pose?
  bool dirty() const;
  void mark_written() { written_ = state(); }

private:
  std::vector<EditState> history_;
  std::size_t present_ = 0;
  std::optional<EditState> gesture_;
  EditState written_;
};

} // namespace tutu::app
