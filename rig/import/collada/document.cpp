#include "rig/import/collada/collada.h"

#include "rig/error.h"
#include "rig/io/file_io.h"

#include <algorithm>
#include <pugixml.hpp>

namespace tutu::rig::import_detail {
namespace {

constexpr int k_deepest = 1000; ///< elements in each other; what walks the tree by recursion stands more

std::string line_of(std::string_view text, std::ptrdiff_t offset) {
  const std::string_view before =
      text.substr(0, std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)), text.size()));
  return "line " + std::to_string(1 + std::ranges::count(before, '\n'));
}

} // namespace

ColladaDocument::ColladaDocument(const std::string& file) : ColladaDocument(file, read_file(file)) {}

ColladaDocument::ColladaDocument(const std::string& file, std::string_view text)
    : file_(file), tree_(std::make_shared<pugi::xml_document>()) {
  // Entities other than XML's own five, and what a DOCTYPE declares, stay the text that they are.
  const pugi::xml_parse_result parsed = tree_->load_buffer(text.data(), text.size(), pugi::parse_default);
  if (parsed.status == pugi::status_out_of_memory)
    throw InputError(file_, "", "more elements than there is memory for", "a Collada file");
  if (!parsed)
    throw InputError(file_, line_of(text, parsed.offset),
                     "a file that cannot be read (" + std::string(parsed.description()) + ")", "a Collada file");
  index();
}

void ColladaDocument::index() {
  int depth = 0;
  for (pugi::xml_node node = tree_->first_child(); node;) {
    const std::string_view id = node.attribute("id").value();
    if (!id.empty() && !by_id_.emplace(id, node.internal_object()).second) twice_.insert(id);
    if (node.first_child()) {
      if (++depth > k_deepest)
        throw InputError(file_, "", "elements more than " + std::to_string(k_deepest) + " deep in each other",
                         "a Collada file");
      node = node.first_child();
      continue;
    }
    while (node && !node.next_sibling()) {
      node = node.parent();
      --depth;
    }
    if (node) node = node.next_sibling();
  }
}

pugi::xml_node ColladaDocument::root() const { return tree_->child("COLLADA"); }

pugi::xml_node ColladaDocument::element(std::string_view id) const {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return {};
  return pugi::xml_node(static_cast<pugi::xml_node_struct*>(const_cast<void*>(found->second)));
}

pugi::xml_node ColladaDocument::referred(std::string_view uri) const {
  return uri.starts_with('#') ? element(uri.substr(1)) : pugi::xml_node();
}

} // namespace tutu::rig::import_detail
