// The proxies in hand with their history: every step back to the start, and whether the file has them.
#pragma once

#include "proxies/collider.h"

#include <optional>
#include <vector>

namespace tutu::app {

/// What is edited, as plain values.
struct ProxyEditState {
  std::vector<proxies::Proxy> proxies;
  std::optional<int> selected;
};

/// To the bit.
bool same_proxies(const std::vector<proxies::Proxy>& a, const std::vector<proxies::Proxy>& b);

/// States are immutable once in the history; there is always one.
class ProxyDocument {
public:
  /// `start` counts as written.
  explicit ProxyDocument(std::vector<proxies::Proxy> start);

  /// What is seen: the gesture's state while there is one, else the present step of the history.
  const ProxyEditState& state() const { return gesture_ ? *gesture_ : history_[present_]; }

  /// One step. Steps that had been undone are gone.
  void change(ProxyEditState next);
  /// No step: a selection is nothing to undo.
  void select(std::optional<int> proxy);

  /// A drag shows any number of states and becomes one step when it is kept, or none when dropped or when it changed
  /// nothing.
  void show(ProxyEditState next) { gesture_ = std::move(next); }
  void keep();
  void drop() { gesture_.reset(); }

  /// False at the end of the history. A gesture is dropped.
  bool undo();
  bool redo();
  std::size_t undo_depth() const { return present_; }
  std::size_t redo_depth() const { return history_.size() - 1 - present_; }

  bool dirty() const { return !same_proxies(state().proxies, written_); }
  void mark_written() { written_ = state().proxies; }

private:
  std::vector<ProxyEditState> history_;
  std::size_t present_ = 0;
  std::optional<ProxyEditState> gesture_;
  std::vector<proxies::Proxy> written_;
};

} // namespace tutu::app
