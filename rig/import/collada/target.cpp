// What a channel's address names [COLLADA 1.4.1, Address Syntax].
#include "rig/import/collada/node_transform.h"
#include "rig/import/collada/source.h"

#include <deque>

namespace tutu::rig::import_detail {
namespace {

bool is_node(const pugi::xml_node& element) { return std::string_view(element.name()) == "node"; }

/// The nearest <node> below with this sid: level by level.
pugi::xml_node node_below(const pugi::xml_node& top, std::string_view sid) {
  std::deque<pugi::xml_node> open = {top};
  while (!open.empty()) {
    for (const pugi::xml_node child : open.front().children()) {
      if (is_node(child) && child.attribute("sid").value() == sid) return child;
      if (is_node(child)) open.push_back(child);
    }
    open.pop_front();
  }
  return {};
}

/// The number that ".X", "(i)" or "(i)(j)" selects.
std::optional<int> number_of(ElementKind kind, std::string_view selector) {
  if (selector.starts_with('.')) {
    const std::string_view name = selector.substr(1);
    if (kind == ElementKind::rotate && name == "ANGLE") return 3;
    if (kind == ElementKind::skew && name == "ANGLE") return 0;
    const bool has_axes = kind == ElementKind::translate || kind == ElementKind::rotate || kind == ElementKind::scale;
    const std::size_t axis = name.size() == 1 ? std::string_view("XYZ").find(name) : name.npos;
    return has_axes && axis != name.npos ? std::optional(static_cast<int>(axis)) : std::nullopt;
  }
  std::vector<std::size_t> indices;
  while (!selector.empty()) {
    const std::size_t close = selector.find(')');
    if (selector[0] != '(' || close == selector.npos) return std::nullopt;
    const std::optional<std::size_t> index = index_of(selector.substr(1, close - 1));
    if (!index || *index >= 16) return std::nullopt;
    indices.push_back(*index);
    selector.remove_prefix(close + 1);
  }
  if (indices.size() == 1) return static_cast<int>(indices[0]);
  // Column first: so write those who write it (FCollada), though the matrix stands there by rows.
  if (indices.size() == 2 && kind == ElementKind::matrix && indices[0] < 4 && indices[1] < 4)
    return static_cast<int>(4 * indices[1] + indices[0]);
  return std::nullopt;
}

constexpr int count_of(ElementKind kind) {
  switch (kind) {
  case ElementKind::matrix: return 16;
  case ElementKind::translate: return 3;
  case ElementKind::rotate: return 4;
  case ElementKind::scale: return 3;
  case ElementKind::lookat: return 9;
  case ElementKind::skew: return 7;
  }
  return 0;
}

} // namespace

std::optional<Target> target_of(const ColladaDocument& document, const std::string& address) {
  const std::size_t first_slash = address.find('/'), last_slash = address.rfind('/');
  if (first_slash == address.npos) return std::nullopt;
  Target target{document.element(std::string_view(address).substr(0, first_slash)), 0, std::nullopt};
  for (std::size_t at = first_slash; at < last_slash && target.node;) {
    const std::size_t next = address.find('/', at + 1);
    target.node = node_below(target.node, std::string_view(address).substr(at + 1, next - at - 1));
    at = next;
  }
  if (!target.node || !is_node(target.node)) return std::nullopt;
  const std::vector<TransformElement> elements = transform_elements(document, target.node);
  const std::string_view last = std::string_view(address).substr(last_slash + 1);
  // A sid may have dots in it: the whole name counts before one with a selector behind it.
  for (const std::size_t length : {last.size(), last.find('('), last.rfind('.')}) {
    if (length == last.npos || length == 0) continue;
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (elements[e].sid != last.substr(0, length)) continue;
      target.element = e;
      if (length == last.size()) return target;
      target.number = number_of(elements[e].kind, last.substr(length));
      if (target.number && *target.number < count_of(elements[e].kind)) return target;
    }
  }
  return std::nullopt;
}

} // namespace tutu::rig::import_detail
