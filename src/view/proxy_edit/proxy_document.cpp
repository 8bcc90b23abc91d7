#include "src/view/proxy_edit/proxy_document.h"

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

} // namespace tutu::app
