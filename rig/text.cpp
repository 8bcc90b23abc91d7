#include "rig/text.h"

#include <cstddef>
#include <cstdint>

namespace tutu {
namespace {

/// Bytes of the character that begins the text, 0 where that is none [RFC 3629, 4]; `code` is its number.
std::size_t character_at(std::string_view text, std::uint32_t& code) {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[k])); };
  const std::uint32_t first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (length == 0 || length > text.size()) return 0;
  code = length == 1 ? first : first & (0x7Fu >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0u) != 0x80u) return 0;
    code = code << 6 | (byte(k) & 0x3Fu);
  }
  const bool too_long = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  return too_long || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF ? 0 : length;
}

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

} // namespace

bool is_plain_text(std::string_view text) {
  std::uint32_t code = 0;
  while (!text.empty()) {
    const std::size_t length = character_at(text, code);
    if (length == 0 || is_control(code)) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string plain_text(std::string_view text, char instead) {
  std::string plain;
  std::uint32_t code = 0;
  while (!text.empty()) {
    const std::size_t length = character_at(text, code);
    if (length == 0 || is_control(code)) plain += instead;
    else plain += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return plain;
}

} // namespace tutu
