#include "src/study/report/html.h"

#include <cstdint>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

constexpr const char* k_style = R"(
:root{color-scheme:light}
body{margin:0;background:#fbfbfc;color:#20242c;font:16px/1.5 system-ui,sans-serif}
main{max-width:72rem;margin:0 auto;padding:1rem}
h1{font-size:1.5rem;line-height:1.25;margin:.4rem 0}
h2{font-size:1.15rem;margin:2rem 0 .5rem}
p{margin:.4rem 0}
.soft{color:#59616e}
.verdict{border-left:.4rem solid #59616e;background:#fff;padding:.6rem .9rem;margin:1rem 0;box-shadow:0 1px 3px #0002}
figure{margin:0;background:#fff;border-radius:.5rem;padding:.6rem;box-shadow:0 1px 3px #0002}
svg{width:100%;height:auto;display:block}
svg text{font:12px system-ui,sans-serif;fill:#59616e}
.grid{stroke:#e6e8ec}
.scroll{overflow-x:auto;background:#fff;border-radius:.5rem;box-shadow:0 1px 3px #0002}
table{border-collapse:collapse;width:100%;font-size:.9rem;font-variant-numeric:tabular-nums}
th,td{padding:.3rem .6rem;text-align:right;white-space:nowrap;border-bottom:1px solid #eceef1}
th:first-child,td:first-child{text-align:left;position:sticky;left:0;background:#fff}
)";

} // namespace

std::string html_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') result += "&amp;";
    else if (c == '<') result += "&lt;";
    else if (c == '>') result += "&gt;";
    else if (c == '"') result += "&quot;";
    else if (c == '\'') result += "&#39;";
    else result += c;
  }
  return result;
}

std::string html_lines(const std::string& text) {
  std::string html;
  for (const char c : html_escaped(text)) html += c == '\n' ? std::string("<br>\n") : std::string(1, c);
  return html;
}

std::string script_value(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c); // < stands in strings only
  return text;
}

std::string base64(const std::string& bytes) {
  constexpr const char* k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? k_digits[group >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

std::string page_head(const std::string& title, const std::string& style) {
  return fmt::format("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
                     "content=\"width=device-width,initial-scale=1\"><title>{0}</title><style>{1}{2}</style></head>\n"
                     "<body><main>\n<h1>{0}</h1>\n",
                     html_escaped(title), k_style, style);
}

} // namespace tutu::app
