// Text that comes from outside: fit to be shown and handed on, or made so.
#pragma once

#include <string>
#include <string_view>

namespace tutu {

/// Valid UTF-8 [RFC 3629] without control characters (C0, DEL, C1).
bool is_plain_text(std::string_view text);

/// The text with `instead` in place of each control character and of each byte that is not UTF-8.
std::string plain_text(std::string_view text, char instead = '_');

/// "line 3, column 14" of a byte offset; both count from 1, an offset behind the text means its end.
std::string line_and_column(std::string_view text, std::size_t offset);

} // namespace tutu
