#include "rig/import/collada/source.h"

#include "rig/text.h"

#include <algorithm>
#include <charconv>

namespace tutu::rig::import_detail {

std::string shown(std::string_view text) { return plain_text(text.substr(0, 80)); }

std::vector<std::string_view> words(std::string_view text) {
  constexpr const char* k_blanks = " \t\r\n";
  std::vector<std::string_view> found;
  for (std::size_t at = text.find_first_not_of(k_blanks); at != text.npos; at = text.find_first_not_of(k_blanks, at)) {
    const std::size_t end = std::min(text.find_first_of(k_blanks, at), text.size());
    found.push_back(text.substr(at, end - at));
    at = end;
  }
  return found;
}

std::vector<std::string_view> words_of(const pugi::xml_node& element) {
  std::vector<std::string_view> found;
  for (const pugi::xml_node piece : element.children()) {
    if (piece.type() != pugi::node_pcdata && piece.type() != pugi::node_cdata) continue;
    const std::vector<std::string_view> more = words(piece.value());
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range)
    return word.find("e-") != word.npos || word.find("E-") != word.npos
               ? std::optional(0.0)
               : std::nullopt; // too small or too large for any number
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::optional<std::size_t> index_of(std::string_view word) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

std::size_t index_attribute(const pugi::xml_node& element, const char* name, std::size_t otherwise) {
  const pugi::xml_attribute attribute = element.attribute(name);
  return attribute ? index_of(attribute.value()).value_or(otherwise) : otherwise;
}

pugi::xml_node input_of(const pugi::xml_node& element, std::string_view semantic) {
  for (const pugi::xml_node input : element.children("input"))
    if (input.attribute("semantic").value() == semantic) return input;
  return {};
}

SourceArray source_array(const ColladaDocument& document, const pugi::xml_node& source) {
  const pugi::xml_node accessor = source.child("technique_common").child("accessor");
  pugi::xml_node array = document.referred(accessor.attribute("source").value());
  for (const char* kind : {"float_array", "Name_array", "IDREF_array", "int_array", "SIDREF_array"})
    if (!array) array = source.child(kind);
  SourceArray result;
  result.words = words_of(array);
  result.count = result.words.size();
  if (!accessor) return result;
  result.stride = std::max<std::size_t>(index_attribute(accessor, "stride", 1), 1);
  result.offset = std::min(index_attribute(accessor, "offset", 0), result.words.size());
  result.count =
      std::min(index_attribute(accessor, "count", result.count), (result.words.size() - result.offset) / result.stride);
  return result;
}

} // namespace tutu::rig::import_detail
