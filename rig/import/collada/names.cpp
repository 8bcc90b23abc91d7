// What a Collada file calls its nodes and meshes, and the space its skins were bound in.
#include "rig/import/collada/source.h"

namespace tutu::rig::import_detail {

void each_element(const ColladaDocument& document, const std::function<void(const pugi::xml_node&)>& look) {
  const pugi::xml_node top = document.root();
  for (pugi::xml_node node = top; node;) {
    look(node);
    pugi::xml_node next = node.first_child();
    while (!next && node && node != top) {
      next = node.next_sibling();
      node = node.parent();
    }
    node = next;
  }
}

std::string reference_name(const pugi::xml_node& node) {
  const std::string id = node.attribute("id").value();
  return id.empty() ? node.attribute("sid").value() : id;
}

std::map<std::string, std::string> display_names(const ColladaDocument& document) {
  std::map<std::string, std::string> names;
  each_element(document, [&](const pugi::xml_node& node) {
    if (std::string_view(node.name()) != "node") return;
    const std::string reference = reference_name(node), name = node.attribute("name").value();
    if (!reference.empty()) names.emplace(reference, name.empty() ? reference : name);
  });
  return names;
}

std::map<std::string, std::string> skin_names(const ColladaDocument& document) {
  std::map<std::string, std::string> names;
  each_element(document, [&](const pugi::xml_node& node) {
    const std::string sid = node.attribute("sid").value();
    if (std::string_view(node.name()) == "node" && !sid.empty()) names.emplace(reference_name(node), sid);
  });
  return names;
}

std::map<std::string, BoundGeometry> bound_geometries(const ColladaDocument& document) {
  std::map<std::string, BoundGeometry> geometries;
  each_element(document, [&](const pugi::xml_node& element) {
    const std::string_view kind = element.name();
    if (kind == "geometry") {
      geometries[element.attribute("id").value()].name = element.attribute("name").value();
    } else if (kind == "skin") {
      const std::string_view source = element.attribute("source").value();
      const std::vector<std::string_view> entries = words_of(element.child("bind_shape_matrix"));
      if (!source.starts_with('#') || entries.size() != 16) return;
      Affine shape = Affine::Identity();
      for (int entry = 0; entry < 12; ++entry)
        shape(entry / 4, entry % 4) = number_of(entries[static_cast<std::size_t>(entry)]).value_or(0.0);
      if (shape.matrix().allFinite()) geometries[std::string(source.substr(1))].bind_shape = shape;
    }
  });
  return geometries;
}

} // namespace tutu::rig::import_detail
