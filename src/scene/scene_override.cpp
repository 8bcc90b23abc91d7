#include "src/scene/scene_override.h"

#include "rig/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {

void override_setting(SceneDescription& description, const std::string& assignment, const std::string& option) {
  const std::size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : assignment.substr(equals + 1);
  const auto refuse = [&](const std::string& expected) { throw InputError("", option, assignment, expected); };
  if (key == "proxies") {
    std::error_code error;
    const bool is_file = std::filesystem::is_regular_file(value, error);
    if (!is_file && value != "none") refuse("a proxies file, or none");
    if (is_file) description.proxies = value;
    else description.proxies.reset();
    return;
  }
  const SettingRow* row = find_setting(key);
  if (!row) refuse(fmt::format("KEY=VALUE with one of: {}, proxies", fmt::join(setting_names(), ", ")));
  const auto number = value_of(*row, value);
  if (!number) refuse(key + " " + expected_of(*row));
  description.changes.push_back({row, *number, option});
}

} // namespace tutu::app
