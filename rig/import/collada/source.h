// Private to the importer: the arrays of a Collada file, <source> with its <accessor>, and lists of numbers.
#pragma once

#include "rig/import/collada/collada.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig::import_detail {

/// Looks at every element below the root, parents first.
void each_element(const ColladaDocument& document, const std::function<void(const pugi::xml_node&)>& look);

/// What a message shows of the file's own text: plain and not long.
std::string shown(std::string_view text);

/// The words between blanks; they point into the text.
std::vector<std::string_view> words(std::string_view text);
/// Those of an element's own text, which comments may part.
std::vector<std::string_view> words_of(const pugi::xml_node& element);
/// A number as XML Schema and the C library write it; none where the word is no number. May be infinite or NaN.
std::optional<double> number_of(std::string_view word);
/// A whole number from 0 on.
std::optional<std::size_t> index_of(std::string_view word);
std::size_t index_attribute(const pugi::xml_node& element, const char* name, std::size_t otherwise);

/// The <input> of a semantic; none where there is none.
pugi::xml_node input_of(const pugi::xml_node& element, std::string_view semantic);

/// What an accessor gives: element i is words[offset + i * stride] and the stride - 1 behind it; all are there.
struct SourceArray {
  std::vector<std::string_view> words;
  std::size_t count = 0, stride = 1, offset = 0;

  std::string_view word(std::size_t element, std::size_t part = 0) const {
    return words[offset + element * stride + part];
  }
};
/// Of a <source>, whose array may stand elsewhere in the document. An accessor that claims more than there is gives
/// what there is; without one the array is given word by word.
SourceArray source_array(const ColladaDocument& document, const pugi::xml_node& source);

} // namespace tutu::rig::import_detail
