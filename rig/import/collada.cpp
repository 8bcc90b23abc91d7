// What assimp 5.2.5 does not tell of a Collada file: it drops weights of a skin that are negative or not a number,
// follows joint indices beyond its own arrays, and does not say which of its elements is in another document. Only
// <skin> elements and references are looked at; anything else is assimp's to judge.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/detail/reach.h"
#include "rig/io/file_io.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace tutu::rig::import_detail {
namespace {

constexpr const char* k_blanks = " \t\r\n";

/// What stands between `open` and `close`, from `from` on, which moves behind it; empty at the end of the text.
std::string_view between(std::string_view text, std::string_view open, std::string_view close, std::size_t& from) {
  const std::size_t start = text.find(open, from);
  const std::size_t end = start == text.npos ? start : text.find(close, start + open.size());
  from = end == text.npos ? text.size() : end + close.size();
  return end == text.npos ? std::string_view() : text.substr(start + open.size(), end - start - open.size());
}

/// The text of an element without children: <name ...>text</name>.
std::string_view text_of(std::string_view parent, const std::string& name) {
  const std::string open = "<" + name, close = "</" + name + ">";
  for (std::size_t from = 0; from < parent.size();) {
    const std::size_t start = parent.find(open, from);
    if (start == parent.npos) break;
    from = start + open.size();
    if (parent.find_first_of(">" + std::string(k_blanks), from) != from) continue; // a longer name
    const std::size_t tag = parent.find('>', from), end = parent.find(close, from);
    return tag < end && end != parent.npos ? parent.substr(tag + 1, end - tag - 1) : std::string_view();
  }
  return {};
}

/// `tag` begins with a blank.
std::string_view attribute(std::string_view tag, const std::string& name) {
  for (const char quote : {'"', '\''}) {
    std::size_t from = 0;
    const std::string open = " " + name + "=" + quote;
    if (tag.find(open) != tag.npos) return between(tag, open, std::string_view(&quote, 1), from);
  }
  return {};
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> found;
  for (std::size_t at = text.find_first_not_of(k_blanks); at != text.npos; at = text.find_first_not_of(k_blanks, at)) {
    const std::size_t end = std::min(text.find_first_of(k_blanks, at), text.size());
    found.push_back(text.substr(at, end - at));
    at = end;
  }
  return found;
}

/// The words of the array in the <source> that "#id" names.
std::vector<std::string_view> array_of(std::string_view skin, std::string_view reference) {
  std::size_t from = 0;
  while (from < skin.size()) {
    const std::string_view source = between(skin, "<source ", "</source>", from);
    if (reference.empty() ||
        attribute(" " + std::string(source.substr(0, source.find('>'))), "id") != reference.substr(1))
      continue;
    for (const char* kind : {"float_array", "Name_array", "IDREF_array"})
      if (const std::string_view text = text_of(source, kind); !text.empty()) return words(text);
  }
  return {};
}

struct Input {
  std::size_t offset = 0;
  std::vector<std::string_view> values;
  bool found = false;
};

std::size_t index_of(std::string_view word) {
  std::size_t value = ~std::size_t{0};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? value : ~std::size_t{0};
}

void check_skin(std::string_view skin, const std::string& file) {
  const std::string place =
      "skin of " + std::string(attribute(" " + std::string(skin.substr(0, skin.find('>'))), "source"));
  std::size_t from = 0;
  const std::string_view weights = between(skin, "<vertex_weights", "</vertex_weights>", from);
  Input joint, weight;
  std::size_t stride = 0;
  for (std::size_t at = 0; at < weights.size();) {
    const std::string_view tag = between(weights, "<input", ">", at);
    if (tag.empty()) continue;
    const std::size_t offset = std::min<std::size_t>(index_of(attribute(tag, "offset")), 64); // none has so many
    stride = std::max(stride, offset + 1);
    const std::string_view semantic = attribute(tag, "semantic");
    if (semantic == "JOINT") joint = {offset, array_of(skin, attribute(tag, "source")), true};
    if (semantic == "WEIGHT") weight = {offset, array_of(skin, attribute(tag, "source")), true};
  }
  if (!joint.found || !weight.found) return; // assimp says what is missing
  for (const std::string_view word : weight.values) {
    const double value = std::strtod(std::string(word).c_str(), nullptr);
    if (!std::isfinite(value) || value < 0.0)
      throw InputError(file, place, "weight " + std::string(word.substr(0, 40)), "a finite weight, not negative");
  }
  const std::vector<std::string_view> indices = words(text_of(weights, "v"));
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const bool is_joint = i % stride == joint.offset, is_weight = i % stride == weight.offset;
    const Input& input = is_joint ? joint : weight;
    if ((is_joint || is_weight) && index_of(indices[i]) >= input.values.size())
      throw InputError(file, place,
                       (is_joint ? "joint index " : "weight index ") + std::string(indices[i].substr(0, 40)),
                       "an index below " + std::to_string(input.values.size()));
  }
}

/// What a body cannot be read without, and the attribute that says where it is: "#id", or another document's address.
constexpr std::pair<const char*, const char*> k_references[] = {{"<instance_visual_scene", "url"},
                                                                {"<instance_node", "url"},
                                                                {"<instance_geometry", "url"},
                                                                {"<instance_controller", "url"},
                                                                {"<instance_effect", "url"},
                                                                {"<skin", "source"},
                                                                {"<morph", "source"}};

void check_references(std::string_view text, const std::string& file) {
  const Reach reach(file);
  for (const auto& [element, key] : k_references)
    for (std::size_t from = 0; from < text.size();) {
      const std::string_view name = attribute(between(text, element, ">", from), key);
      if (name.empty() || name[0] == '#') continue;
      if (!reach.holds_name(name)) throw out_of_reach(file, element + 1, name);
      throw InputError(file, element + 1, std::string(name.substr(0, 120)) + ", in another document",
                       "all of the character in one file");
    }
}

} // namespace

void check_collada(const std::string& file) {
  const std::string text = read_file(file);
  check_references(text, file);
  for (std::size_t from = 0; from < text.size();) {
    const std::string_view skin = between(text, "<skin ", "</skin>", from);
    if (!skin.empty()) check_skin(skin, file);
  }
}

} // namespace tutu::rig::import_detail
