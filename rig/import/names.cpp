// Text of a foreign file made plain: what is behind the importer writes it into lines, tables and terminals.
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"
#include "rig/text.h"

#include <map>
#include <set>

namespace tutu::rig::import_detail {
namespace {

/// What each name that is not plain becomes. Names that were different stay so.
std::map<std::string, std::string> plain_names(const std::set<std::string>& names) {
  std::set<std::string> taken = names;
  std::map<std::string, std::string> plain;
  for (const std::string& name : names) {
    if (is_plain_text(name)) continue;
    const std::string base = plain_text(name);
    std::string next = base;
    for (int i = 2; !taken.insert(next).second; ++i) next = base + "_" + std::to_string(i);
    plain[name] = next;
  }
  return plain;
}

/// Puts plain names in the place of the others; `name_of(item)` is where an item's name stands.
template <typename Items, typename NameOf> void clean(Items& items, std::vector<std::string>& cleaned, NameOf name_of) {
  std::set<std::string> names;
  for (auto& item : items) names.insert(name_of(item));
  const std::map<std::string, std::string> plain = plain_names(names);
  for (auto& item : items)
    if (const auto found = plain.find(name_of(item)); found != plain.end()) name_of(item) = found->second;
  for (const auto& [before, after] : plain) cleaned.push_back(after);
}

} // namespace

void clean_names(Import& import) {
  std::vector<std::string> cleaned;
  clean(
      import.character.skeleton.names, cleaned, [](std::string & name) -> auto& { return name; });
  clean(
      import.character.mesh.parts, cleaned, [](MeshPart & part) -> auto& { return part.name; });
  clean(
      import.clips, cleaned, [](ChannelClip & clip) -> auto& { return clip.name; });

  ImportReport& report = import.report;
  report.format = plain_text(report.format);
  for (std::string& note : report.notes) note = plain_text(note);
  if (!cleaned.empty())
    report.notes.push_back(count_of(cleaned.size(), "name") +
                           " of joints, meshes or clips with control characters or " +
                           "bytes that are not UTF-8 got '_' in their place: " + list_of(cleaned));
}

} // namespace tutu::rig::import_detail
