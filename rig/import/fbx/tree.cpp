#include "rig/import/fbx/tree.h"

#include "rig/import/fbx/parse.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <zlib.h>

namespace tutu::rig::import_detail {
namespace {

std::size_t size_of(char element) { return element == 'b' ? 1 : element == 'i' || element == 'f' ? 4 : 8; }

/// The bytes of a binary array's elements.
std::string unpacked(const FbxValue& array) {
  const std::size_t size = std::size_t{array.count} * size_of(array.element);
  if (!array.is_deflated) return std::string(array.text); // taken with this very size
  constexpr std::size_t k_most_inflation = 1032;          // [zlib technical details]: no stream grows more
  if (size > array.text.size() * k_most_inflation) throw FbxUnreadable("an array longer than its bytes can be");
  std::string bytes(size, '\0');
  uLongf length = size;
  if (::uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length, reinterpret_cast<const Bytef*>(array.text.data()),
                   array.text.size()) != Z_OK ||
      length != size)
    throw FbxUnreadable("an array that cannot be inflated");
  return bytes;
}

template <typename Stored, typename T> void convert(const std::string& bytes, std::vector<T>& numbers) {
  for (std::size_t at = 0; at + sizeof(Stored) <= bytes.size(); at += sizeof(Stored)) {
    Stored stored;
    std::memcpy(&stored, bytes.data() + at, sizeof stored);
    numbers.push_back(static_cast<T>(stored));
  }
}

/// The words of a text's array.
std::vector<std::string_view> words_of_text(const FbxValue& array) {
  constexpr std::string_view k_between = ", \t\r\n";
  std::vector<std::string_view> words;
  for (std::size_t at = array.text.find_first_not_of(k_between); at != array.text.npos;) {
    const std::size_t end = std::min(array.text.find_first_of(k_between, at), array.text.size());
    words.push_back(array.text.substr(at, end - at));
    at = array.text.find_first_not_of(k_between, end);
  }
  if (words.size() != array.count) throw FbxUnreadable("an array that is not as long as it says");
  return words;
}

template <typename T> T parsed(std::string_view word) {
  T value{}; // stays 0 where the number is too near to it
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_tiny = error == std::errc::result_out_of_range && word.find_first_of("eE") != word.npos &&
                       word[word.find_first_of("eE") + 1] == '-';
  if (end != word.data() + word.size() || (error != std::errc() && !is_tiny))
    throw FbxUnreadable("an array of what is no number");
  return value;
}

/// The value that is all of an element's array; null where its values are the array.
const FbxValue* array_in(const FbxElement& element) {
  if (element.values.empty()) return nullptr;
  const FbxValue& first = element.values.front();
  return first.kind == FbxValue::Kind::array || first.kind == FbxValue::Kind::text_array ? &first : nullptr;
}

} // namespace

const FbxElement* FbxElement::child(std::string_view wanted) const {
  const auto found = std::ranges::find(children, wanted, &FbxElement::name);
  return found == children.end() ? nullptr : &*found;
}

bool is_of_use(std::string_view parent, std::string_view name) {
  const auto is_one_of = [&](std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, name) != names.end();
  };
  if (parent.empty()) return is_one_of({"FBXHeaderExtension", "Definitions", "Objects", "Connections"});
  if (parent != "Objects") return true;
  return is_one_of({"Model", "AnimationStack", "AnimationLayer", "AnimationCurveNode", "AnimationCurve"});
}

FbxTree parse_fbx(std::string_view bytes) {
  FbxTree tree;
  tree.is_text = !bytes.starts_with(k_binary_start);
  tree.elements = tree.is_text ? parse_text_fbx(bytes, tree.version) : parse_binary_fbx(bytes, tree.version);
  return tree;
}

std::optional<double> number_of(const FbxValue& value) {
  if (value.kind == FbxValue::Kind::integer) return static_cast<double>(value.integer);
  if (value.kind == FbxValue::Kind::real) return value.real;
  return std::nullopt;
}

std::optional<std::int64_t> integer_of(const FbxValue& value) {
  if (value.kind == FbxValue::Kind::integer) return value.integer;
  return std::nullopt;
}

std::vector<double> reals_of(const FbxElement& element) {
  std::vector<double> numbers;
  const FbxValue* array = array_in(element);
  if (!array) {
    for (const FbxValue& value : element.values)
      if (const std::optional<double> number = number_of(value)) numbers.push_back(*number);
      else throw FbxUnreadable("an array of what is no number");
  } else if (array->kind == FbxValue::Kind::text_array) {
    for (const std::string_view word : words_of_text(*array)) numbers.push_back(parsed<double>(word));
  } else if (array->element == 'f') {
    convert<float>(unpacked(*array), numbers);
  } else if (array->element == 'd') {
    convert<double>(unpacked(*array), numbers);
  } else {
    throw FbxUnreadable("whole numbers where others should be");
  }
  return numbers;
}

std::vector<std::int64_t> integers_of(const FbxElement& element) {
  std::vector<std::int64_t> numbers;
  const FbxValue* array = array_in(element);
  if (!array) {
    for (const FbxValue& value : element.values)
      if (const std::optional<std::int64_t> number = integer_of(value)) numbers.push_back(*number);
      else throw FbxUnreadable("an array of what is no number");
  } else if (array->kind == FbxValue::Kind::text_array) {
    for (const std::string_view word : words_of_text(*array)) numbers.push_back(parsed<std::int64_t>(word));
  } else if (array->element == 'i') {
    convert<std::int32_t>(unpacked(*array), numbers);
  } else if (array->element == 'l') {
    convert<std::int64_t>(unpacked(*array), numbers);
  } else {
    throw FbxUnreadable("other numbers where whole ones should be");
  }
  return numbers;
}

std::vector<std::uint32_t> words_of(const FbxElement& element, const FbxTree& tree) {
  std::vector<std::uint32_t> words;
  const FbxValue* array = array_in(element);
  if (array && array->kind == FbxValue::Kind::array) {
    if (size_of(array->element) != 4) throw FbxUnreadable("other numbers where words of 32 bits should be");
    convert<std::uint32_t>(unpacked(*array), words);
    return words;
  }
  constexpr int k_bits_as_numbers = 7200;
  if (array && tree.version >= k_bits_as_numbers) {
    for (const std::string_view word : words_of_text(*array)) {
      const bool is_whole = word.find_first_not_of("-0123456789") == word.npos;
      words.push_back(is_whole ? static_cast<std::uint32_t>(parsed<std::int64_t>(word))
                               : std::bit_cast<std::uint32_t>(static_cast<float>(parsed<double>(word))));
    }
    return words;
  }
  for (const double number : reals_of(element))
    words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(number)));
  return words;
}

} // namespace tutu::rig::import_detail
