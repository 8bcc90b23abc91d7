#include "rig/text.h"

#include <algorithm>

namespace tutu {
namespace {

struct First {
  std::size_t size; ///< bytes
  bool plain;
};

/// The character that a text (not empty) begins with; a byte that begins none is one of its own, not plain.
First first_character(std::string_view text) {
  constexpr First k_broken = {1, false};
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return {1, lead >= 0x20 && lead != 0x7f};
  if (lead < 0xc0 || lead > 0xf4) return k_broken;
  const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (size > text.size()) return k_broken;
  unsigned code = lead & (0x7fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    const auto next = static_cast<unsigned char>(text[i]);
    if ((next & 0xc0) != 0x80) return k_broken;
    code = code << 6 | (next & 0x3f);
  }
  constexpr unsigned k_least[] = {0, 0, 0x80, 0x800, 0x10000}; // by size: fewer bytes would have done
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  if (code < k_least[size] || surrogate || code > 0x10ffff) return k_broken;
  return {size, code >= 0xa0};
}

} // namespace

bool is_plain_text(std::string_view text) {
  while (!text.empty()) {
    const First first = first_character(text);
    if (!first.plain) return false;
    text.remove_prefix(first.size);
  }
  return true;
}

std::string plain_text(std::string_view text, char instead) {
  std::string plain;
  while (!text.empty()) {
    const First first = first_character(text);
    if (first.plain) plain += text.substr(0, first.size);
    else plain += instead;
    text.remove_prefix(first.size);
  }
  return plain;
}

std::string line_and_column(std::string_view text, std::size_t offset) {
  offset = std::min(offset, text.size());
  const std::string_view before = text.substr(0, offset);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');
  const std::size_t column = start == std::string_view::npos ? offset : offset - start - 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(std::max<std::size_t>(column, 1));
}

} // namespace tutu
