// The proxies in hand with their history: every step back to the start, and whether the file has them.
#pragma once

#include "proxies/collider.h"
#include "src/base/edit_history.h"

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

struct SameProxies {
  bool operator()(const ProxyEditState& a, const ProxyEditState& b) const { return same_proxies(a.proxies, b.proxies); }
};

class ProxyDocument : public EditHistory<ProxyEditState, SameProxies> {
public:
  /// `start` counts as written.
  explicit ProxyDocument(std::vector<proxies::Proxy> start)
      : EditHistory({start, std::nullopt}), written_(std::move(start)) {}

  /// No step: a selection is nothing to undo.
  void select(std::optional<int> proxy) { present().selected = proxy; }

  bool dirty() const { return !same_proxies(state().proxies, written_); }
  void mark_written() { written_ = state().proxies; }

private:
  std::vector<proxies::Proxy> written_;
};

} // namespace tutu::app
