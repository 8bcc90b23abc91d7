// JSON as tutu writes it: whatever text it holds, what comes out is UTF-8 and whole.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tutu::app {

/// Indented, with a newline at its end. Bytes that are not UTF-8 (a file may be called so) become U+FFFD.
template <class Json> std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}
inline std::string json_text(const std::vector<std::string>& words) { return json_text(nlohmann::json(words)); }

} // namespace tutu::app
