// The work on a clip with its history: every step back to the start, and what of it is in the files.
#pragma once

#include "src/base/edit_history.h"
#include "src/view/pose/edit_state.h"

namespace tutu::app {

class EditDocument : public EditHistory<EditState> {
public:
  /// `start` counts as written.
  explicit EditDocument(EditState start) : EditHistory(start), written_(std::move(start)) {}

  /// Is there anything that the files do not hold: another clip, or a loose pose?
  bool dirty() const { return state().loose || !same_clip(state(), written_); }
  void mark_written() { written_ = state(); }

private:
  EditState written_;
};

} // namespace tutu::app
