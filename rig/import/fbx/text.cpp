// The text form: "Name: value, value {", elements in it, "}"; ';' begins a comment, "*3 { a: 1,2,3 }" is an array.
#include "rig/import/fbx/parse.h"

#include <algorithm>
#include <charconv>

namespace tutu::rig::import_detail {
namespace {

constexpr std::string_view k_blanks = " \t\r\n";

class Parser {
public:
  explicit Parser(std::string_view text) : text_(text) {}

  /// Up to the end of the text, or below the top up to a closing brace, which is taken.
  std::vector<FbxElement> elements(int depth, std::string_view parent = {}) {
    if (depth > k_deepest_element) throw FbxUnreadable("elements too deep in each other");
    std::vector<FbxElement> found;
    for (;;) {
      skip(k_blanks);
      if (at_end()) {
        if (depth > 0) throw FbxUnreadable("a brace that is not closed");
        return found;
      }
      if (text_[at_] == '}') {
        if (depth == 0) throw FbxUnreadable("a brace that was not opened");
        ++at_;
        return found;
      }
      FbxElement next = element(depth);
      if (is_of_use(parent, next.name)) found.push_back(std::move(next));
    }
  }

private:
  bool at_end() const { return at_ >= text_.size(); }

  /// Blanks and comments; a comment ends before its line's end.
  void skip(std::string_view blanks) {
    for (;;) {
      at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
      if (at_end() || text_[at_] != ';') return;
      at_ = std::min(text_.find('\n', at_), text_.size());
    }
  }

  std::string_view until(std::string_view ends) {
    const std::size_t end = std::min(text_.find_first_of(ends, at_), text_.size());
    const std::string_view taken = text_.substr(at_, end - at_);
    at_ = end;
    return taken;
  }

  FbxElement element(int depth) {
    FbxElement element;
    element.name = until(":\n\"{};,");
    if (at_end() || text_[at_] != ':' || element.name.empty()) throw FbxUnreadable("text that is no element");
    ++at_;
    for (bool goes_on = false;;) {
      skip(goes_on ? k_blanks : " \t\r");
      if (at_end()) return element;
      const char next = text_[at_];
      if (next == '\n' || next == '}') return element;
      goes_on = next == ',';
      if (next == ',') {
        ++at_;
      } else if (next == '{') {
        ++at_;
        element.children = elements(depth + 1, element.name);
        return element;
      } else {
        element.values.push_back(value());
      }
    }
  }

  FbxValue value() {
    FbxValue value;
    if (text_[at_] == '"') {
      ++at_;
      value.kind = FbxValue::Kind::text;
      value.text = until("\"");
      if (at_end()) throw FbxUnreadable("a text that is not closed");
      ++at_;
    } else if (text_[at_] == '*') {
      ++at_;
      value = array();
    } else {
      value = bare(until(", \t\r\n{}\":;"));
    }
    return value;
  }

  FbxValue array() {
    FbxValue value;
    value.kind = FbxValue::Kind::text_array;
    const std::string_view digits = until(" \t\r\n{");
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value.count);
    if (error != std::errc() || end != digits.data() + digits.size()) throw FbxUnreadable("an array without a length");
    for (const char expected : {'{', 'a', ':'}) {
      skip(k_blanks);
      if (at_end() || text_[at_] != expected) throw FbxUnreadable("an array that is none");
      ++at_;
    }
    value.text = until("}");
    if (at_end()) throw FbxUnreadable("a brace that is not closed");
    ++at_;
    return value;
  }

  /// A number, or a word that stands for itself.
  static FbxValue bare(std::string_view word) {
    if (word.empty()) throw FbxUnreadable("text that is no element");
    FbxValue value;
    const char* const end = word.data() + word.size();
    if (std::from_chars(word.data(), end, value.integer).ptr == end) return value;
    value.kind = FbxValue::Kind::real;
    if (std::from_chars(word.data(), end, value.real).ptr == end) return value;
    value.kind = FbxValue::Kind::text;
    value.text = word;
    return value;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

} // namespace

std::vector<FbxElement> parse_text_fbx(std::string_view text, int& version) {
  if (text.find('\0') != text.npos) throw FbxUnreadable("neither text nor binary FBX");
  constexpr std::string_view k_mark = "\xEF\xBB\xBF"; // some write a byte order mark
  if (text.starts_with(k_mark)) text.remove_prefix(k_mark.size());
  // The version before all else: texts of 6.x are of another grammar.
  const std::size_t at = text.find("FBXVersion:");
  if (at == text.npos) throw FbxUnreadable("neither text nor binary FBX");
  const std::size_t digits = std::min(text.find_first_not_of(" \t", at + 11), text.size());
  if (std::from_chars(text.data() + digits, text.data() + text.size(), version).ec != std::errc())
    throw FbxUnreadable("without a version");
  if (version < 7000 || version >= 8000) throw FbxUnreadable("of version " + std::to_string(version));
  return Parser(text).elements(0);
}

} // namespace tutu::rig::import_detail
