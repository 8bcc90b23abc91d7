// Collada: the checks of its skins and references, and its motion on nodes by their names.
#include "rig/import/collada/collada.h"
#include "rig/error.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_collada(std::string_view input) {
  namespace detail = rig::import_detail;
  const detail::ColladaDocument document(write_input(input, "motion.dae").string(), input);
  detail::check_references(document);
  detail::check_skins(document);
  std::map<std::string, int> node_of;
  for (const auto& [reference, name] : detail::display_names(document)) {
    require(!reference.empty() && !name.empty(), "a node has names");
    const int node = static_cast<int>(node_of.size());
    node_of.emplace(reference, node);
  }
  for (const detail::FileAnimation& animation : detail::animations(document, node_of))
    require_motion(animation, static_cast<int>(node_of.size()));
}

} // namespace tutu::fuzz
