// What assimp 5.2.5 does not tell of a Collada file: it drops weights of a skin that are negative or not a number,
// follows joint indices beyond its own arrays, and does not say which of its elements is in another document.
#include "rig/error.h"
#include "rig/import/collada/source.h"
#include "rig/import/detail/reach.h"

#include <cmath>
#include <functional>

namespace tutu::rig::import_detail {
namespace {

struct Input {
  std::size_t offset = 0;
  SourceArray values;
};

void check_skin(const ColladaDocument& document, const pugi::xml_node& skin) {
  const std::string place = "skin of " + shown(skin.attribute("source").value());
  const pugi::xml_node weights = skin.child("vertex_weights");
  const pugi::xml_node joint_input = input_of(weights, "JOINT"), weight_input = input_of(weights, "WEIGHT");
  if (!joint_input || !weight_input) return; // assimp says what is missing
  const auto offset_of = [](const pugi::xml_node& input) {
    return std::min<std::size_t>(index_attribute(input, "offset", 64), 64); // none has so many
  };
  std::size_t stride = 0;
  for (const pugi::xml_node input : weights.children("input")) stride = std::max(stride, offset_of(input) + 1);
  const auto read = [&](const pugi::xml_node& input) {
    const pugi::xml_node source = document.referred(input.attribute("source").value());
    const std::string_view accessed = source.child("technique_common").child("accessor").attribute("source").value();
    for (const std::string_view id :
         {std::string_view(source.attribute("id").value()), accessed.substr(accessed.starts_with('#'))})
      if (document.is_twice(id))
        throw InputError(document.file(), place, "two elements of the id " + shown(id), "ids of their own");
    return Input{offset_of(input), source_array(document, source)};
  };
  const Input joint = read(joint_input), weight = read(weight_input);
  for (std::size_t i = 0; i < weight.values.count; ++i) {
    const std::string_view word = weight.values.word(i);
    const std::optional<double> value = number_of(word);
    if (!value || !std::isfinite(*value) || *value < 0.0)
      throw InputError(document.file(), place, "weight " + shown(word), "a finite weight, not negative");
  }
  std::size_t i = 0;
  for (const std::string_view word : words_of(weights.child("v"))) {
    const std::size_t offset = i++ % stride;
    const bool is_joint = offset == joint.offset;
    if (!is_joint && offset != weight.offset) continue;
    const std::size_t count = (is_joint ? joint : weight).values.count;
    const std::optional<std::size_t> index = index_of(word);
    if (!index || *index >= count)
      throw InputError(document.file(), place, (is_joint ? "joint index " : "weight index ") + shown(word),
                       "an index below " + std::to_string(count));
  }
}

/// What a body cannot be read without, and the attribute that says where it is: "#id", or another document's address.
constexpr std::pair<const char*, const char*> k_references[] = {{"instance_visual_scene", "url"},
                                                                {"instance_node", "url"},
                                                                {"instance_geometry", "url"},
                                                                {"instance_controller", "url"},
                                                                {"instance_effect", "url"},
                                                                {"skin", "source"},
                                                                {"morph", "source"}};

} // namespace

void check_references(const ColladaDocument& document) {
  const Reach reach(document.file());
  each_element(document, [&](const pugi::xml_node& node) {
    for (const auto& [element, key] : k_references) {
      if (std::string_view(node.name()) != element) continue;
      const std::string_view name = node.attribute(key).value();
      if (name.empty() || name[0] == '#') continue;
      if (!reach.holds_name(name)) throw out_of_reach(document.file(), element, name);
      throw InputError(document.file(), element, shown(name) + ", in another document",
                       "all of the character in one file");
    }
  });
}

void check_skins(const ColladaDocument& document) {
  each_element(document, [&](const pugi::xml_node& node) {
    if (std::string_view(node.name()) == "skin") check_skin(document, node);
  });
}

} // namespace tutu::rig::import_detail
