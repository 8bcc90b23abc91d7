// Text that people read: what of it may stand in a line, and what is made of the rest.
#pragma once

#include <string>
#include <string_view>

namespace tutu {

/// Whether it is UTF-8 [RFC 3629] without control characters (C0, DEL, C1): one line, in every format that has lines.
bool is_plain_text(std::string_view text);

/// The same text with `instead` for each control character and for each byte that is not UTF-8.
std::string plain_text(std::string_view text, char instead = '_');

} // namespace tutu
