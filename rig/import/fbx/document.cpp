#include "rig/import/fbx/document.h"

namespace tutu::rig::import_detail {
namespace {

const FbxElement* top(const FbxTree& tree, std::string_view name) {
  for (const FbxElement& element : tree.elements)
    if (element.name == name) return &element;
  return nullptr;
}

std::string_view text_of(const FbxElement& element, std::size_t value) {
  return element.values.size() > value && element.values[value].kind == FbxValue::Kind::text
             ? element.values[value].text
             : std::string_view();
}

/// "Class::Name" in a text, "Name\0\1Class" in a binary file.
std::string_view name_without_class(std::string_view text) {
  if (const std::size_t at = text.find(std::string_view("\0\1", 2)); at != text.npos) return text.substr(0, at);
  const std::size_t at = text.find("::");
  return at == text.npos ? text : text.substr(at + 2);
}

/// Until 2019 there was one unit of time; a file of later SDKs says which it has [FBX SDK 2020, FbxTime].
double ticks_per_second_of(const FbxTree& tree) {
  constexpr double k_old = 46186158000.0, k_new = 141120000.0;
  constexpr std::int64_t k_says_old = 127;
  const FbxElement* header = top(tree, "FBXHeaderExtension");
  const FbxElement* flags = header ? header->child("OtherFlags") : nullptr;
  const FbxElement* definition = flags ? flags->child("TCDefinition") : nullptr;
  const std::optional<std::int64_t> which =
      definition && !definition->values.empty() ? integer_of(definition->values[0]) : std::nullopt;
  return which.value_or(k_says_old) == k_says_old ? k_old : k_new;
}

const FbxElement* properties_of(const FbxElement& element) { return element.child("Properties70"); }

const FbxElement* property_in(const FbxElement* properties, std::string_view name) {
  if (!properties) return nullptr;
  for (const FbxElement& property : properties->children)
    if (property.name == "P" && text_of(property, 0) == name) return &property;
  return nullptr;
}

constexpr std::size_t k_first_number = 4; ///< behind a property's name, type, label and flags

} // namespace

FbxDocument::FbxDocument(std::string_view bytes)
    : tree_(parse_fbx(bytes)), ticks_per_second_(ticks_per_second_of(tree_)) {
  const FbxElement* objects = top(tree_, "Objects");
  if (!objects) throw FbxUnreadable("without objects");
  for (const FbxElement& element : objects->children) {
    const std::optional<std::int64_t> id = element.values.empty() ? std::nullopt : integer_of(element.values[0]);
    if (!id) continue;
    by_id_.emplace(*id, objects_.size());
    objects_.push_back({*id, element.name, name_without_class(text_of(element, 1)), text_of(element, 2), &element});
  }
  if (const FbxElement* connections = top(tree_, "Connections"))
    for (const FbxElement& element : connections->children) {
      const std::string_view kind = text_of(element, 0);
      if ((kind != "OO" && kind != "OP") || element.values.size() < 3) continue;
      const std::optional<std::int64_t> part = integer_of(element.values[1]), whole = integer_of(element.values[2]);
      if (!part || !whole) continue;
      parts_[*whole].push_back({*part, *whole, text_of(element, 3)});
      const auto parent = by_id_.find(*whole);
      if (kind == "OO" && parent != by_id_.end() && objects_[parent->second].kind == "Model")
        parent_.emplace(*part, parent->second);
    }
  if (const FbxElement* definitions = top(tree_, "Definitions"))
    for (const FbxElement& type : definitions->children)
      if (type.name == "ObjectType" && text_of(type, 0) == "Model")
        if (const FbxElement* found = type.child("PropertyTemplate")) model_template_ = properties_of(*found);
}

const FbxObject* FbxDocument::object(std::int64_t id) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : &objects_[found->second];
}

const std::vector<FbxConnection>& FbxDocument::parts_of(std::int64_t id) const {
  static const std::vector<FbxConnection> none;
  const auto found = parts_.find(id);
  return found == parts_.end() ? none : found->second;
}

const FbxObject* FbxDocument::parent_of(const FbxObject& model) const {
  const auto found = parent_.find(model.id);
  return found == parent_.end() ? nullptr : &objects_[found->second];
}

const FbxElement* FbxDocument::find(const FbxObject& object, std::string_view property) const {
  const FbxElement* own = property_in(properties_of(*object.element), property);
  return own || object.kind != "Model" ? own : property_in(model_template_, property);
}

Vec3 FbxDocument::vector(const FbxObject& object, std::string_view property, const Vec3& otherwise) const {
  const FbxElement* found = find(object, property);
  if (!found || found->values.size() < k_first_number + 3) return otherwise;
  Vec3 result;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> number = number_of(found->values[k_first_number + static_cast<std::size_t>(i)]);
    if (!number) return otherwise;
    result[i] = *number;
  }
  if (!is_in_bounds(result)) throw FbxUnreadable("a property that is no number");
  return result;
}

double FbxDocument::number(const FbxObject& object, std::string_view property, double otherwise) const {
  const FbxElement* found = find(object, property);
  return !found || found->values.size() <= k_first_number
             ? otherwise
             : number_of(found->values[k_first_number]).value_or(otherwise);
}

std::optional<double> FbxDocument::own_number(const FbxObject& object, std::string_view property) const {
  const FbxElement* found = property_in(properties_of(*object.element), property);
  return !found || found->values.size() <= k_first_number ? std::nullopt : number_of(found->values[k_first_number]);
}

std::optional<std::int64_t> FbxDocument::own_integer(const FbxObject& object, std::string_view property) const {
  const FbxElement* found = property_in(properties_of(*object.element), property);
  return !found || found->values.size() <= k_first_number ? std::nullopt : integer_of(found->values[k_first_number]);
}

} // namespace tutu::rig::import_detail
