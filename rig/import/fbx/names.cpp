// Models of one name, which a reader that goes by names cannot tell apart.
#include "rig/error.h"
#include "rig/import/fbx/document.h"
#include "rig/import/fbx/fbx.h"
#include "rig/text.h"

#include <algorithm>
#include <set>

namespace tutu::rig::import_detail {
namespace {

bool is_joint(const FbxObject& model) {
  return model.subkind == "LimbNode" || model.subkind == "Limb" || model.subkind == "Root";
}

std::vector<const FbxObject*> models_of(const FbxDocument& document) {
  std::vector<const FbxObject*> models;
  for (const FbxObject& object : document.objects())
    if (object.kind == "Model" && !object.name.empty()) models.push_back(&object);
  return models;
}

std::string parent_name(const FbxDocument& document, const FbxObject& model) {
  const FbxObject* parent = document.parent_of(model);
  return parent ? plain_text(parent->name) : "the scene";
}

/// A name of the same length that is not taken: its last letters as a number.
std::optional<std::string> free_name(std::string_view name, const std::set<std::string, std::less<>>& taken) {
  constexpr std::size_t k_most_digits = 4;
  std::size_t limit = 1;
  for (std::size_t digits = 1; digits <= std::min(name.size(), k_most_digits); ++digits) {
    limit *= 10;
    for (std::size_t number = 0; number < limit; ++number) {
      const std::string tail = std::to_string(number);
      std::string wanted(name.substr(0, name.size() - digits));
      wanted += std::string(digits - tail.size(), '0') + tail;
      if (!taken.contains(wanted)) return wanted;
    }
  }
  return std::nullopt;
}

} // namespace

std::optional<FbxUniqueNames> with_unique_names(std::string_view bytes) try {
  const FbxDocument document(bytes);
  const std::vector<const FbxObject*> models = models_of(document);
  std::set<std::string, std::less<>> taken, seen;
  for (const FbxObject* model : models) taken.emplace(model->name);
  FbxUniqueNames result;
  for (const FbxObject* model : models) {
    if (seen.emplace(model->name).second) continue;
    const std::optional<std::string> name = free_name(model->name, taken);
    if (!name) return std::nullopt;
    taken.insert(*name);
    if (result.bytes.empty()) result.bytes = bytes;
    result.original.emplace(*name, model->name);
    const auto at = static_cast<std::size_t>(model->name.data() - bytes.data());
    result.bytes.replace(at, name->size(), *name);
  }
  if (result.original.empty()) return std::nullopt;
  return result;
} catch (const FbxUnreadable&) {
  return std::nullopt;
}

void check_fbx_names(const std::string& file, std::string_view bytes) try {
  const FbxDocument document(bytes);
  for (const bool joints : {true, false}) {
    std::map<std::string_view, const FbxObject*> seen;
    for (const FbxObject* model : models_of(document)) {
      if (joints && !is_joint(*model)) continue;
      const auto [first, is_new] = seen.emplace(model->name, model);
      if (!is_new)
        throw InputError(file, (joints ? "joint " : "model ") + plain_text(model->name),
                         "two of this name (in " + parent_name(document, *first->second) + " and in " +
                             parent_name(document, *model) + "), which the reader of FBX cannot tell apart",
                         "names of their own: rename one");
    }
  }
} catch (const FbxUnreadable&) { // whoever cannot read it says so
}

} // namespace tutu::rig::import_detail
