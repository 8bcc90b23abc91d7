#include "src/proxy_edit/proxy_document.h"

#include <algorithm>

namespace tutu::app {
namespace {

bool same_anchor(const proxies::Anchor& a, const proxies::Anchor& b) {
  if (a.count != b.count) return false;
  for (int k = 0; k < a.count; ++k)
    if (a.joints[k] != b.joints[k] || a.weights[k] != b.weights[k] || a.points[k] != b.points[k]) return false;
  return true;
}

bool same_proxy(const proxies::Proxy& a, const proxies::Proxy& b) {
  return a.name == b.name && a.kind == b.kind && same_anchor(a.a, b.a) && same_anchor(a.b, b.b) &&
         a.radius == b.radius && a.taper == b.taper && a.friction == b.friction && a.enabled == b.enabled;
}

} // namespace

bool same_proxies(const std::vector<proxies::Proxy>& a, const std::vector<proxies::Proxy>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_proxy);
}

ProxyDocument::ProxyDocument(std::vector<proxies::Proxy> start) : written_(start) {
  history_.push_back({std::move(start), std::nullopt});
}

void ProxyDocument::change(ProxyEditState next) {
  keep();
  history_.resize(present_ + 1);
  history_.push_back(std::move(next));
  ++present_;
}

void ProxyDocument::select(std::optional<int> proxy) { history_[present_].selected = proxy; }

void ProxyDocument::keep() {
  if (!gesture_) return;
  ProxyEditState next = std::move(*gesture_);
  gesture_.reset();
  if (!same_proxies(next.proxies, state().proxies)) change(std::move(next));
}

bool ProxyDocument::undo() {
  drop();
  if (present_ == 0) return false;
  --present_;
  return true;
}

bool ProxyDocument::redo() {
  drop();
  if (redo_depth() == 0) return false;
  ++present_;
  return true;
}

} // namespace tutu::app
