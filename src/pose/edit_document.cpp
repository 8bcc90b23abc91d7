#include "src/pose/edit_document.h"

namespace tutu::app {

EditDocument::EditDocument(EditState start) : written_(start) { history_.push_back(std::move(start)); }

void EditDocument::change(EditState next) {
  keep();
  history_.resize(present_ + 1);
  history_.push_back(std::move(next));
  ++present_;
}

void EditDocument::keep() {
  if (!gesture_) return;
  EditState next = std::move(*gesture_);
  gesture_.reset();
  change(std::move(next));
}

bool EditDocument::undo() {
  drop();
  if (present_ == 0) return false;
  --present_;
  return true;
}

bool EditDocument::redo() {
  drop();
  if (redo_depth() == 0) return false;
  ++present_;
  return true;
}

bool EditDocument::dirty() const { return state().loose || !same_clip(state(), written_); }

} // namespace tutu::app
