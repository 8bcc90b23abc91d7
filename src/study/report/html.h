// What the pages that tutu writes have in common: their look, and text that stays text.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tutu::app {

/// Text for HTML, in content and in quoted attributes: & < > " ' escaped.
std::string html_escaped(const std::string& text);
/// The same, with a line break for each line.
std::string html_lines(const std::string& text);

/// A value for a <script>, where no text of it can end the script, begin a comment or another script: each < is \u003c.
std::string script_value(const nlohmann::ordered_json& json);

/// RFC 4648.
std::string base64(const std::string& bytes);

/// A page up to and with its heading. `style`: CSS on top of what all pages have.
std::string page_head(const std::string& title, const std::string& style);
inline constexpr const char* k_page_end = "</main></body></html>\n";

} // namespace tutu::app
