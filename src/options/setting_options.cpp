#include "src/options/setting_options.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {

std::vector<CLI::Option*> add_setting_options(CLI::App& command, std::vector<SettingChange>& changes,
                                              std::initializer_list<std::string_view> which) {
  std::vector<CLI::Option*> options;
  for (const SettingRow& row : settings_table()) {
    if (which.size() > 0 && std::find(which.begin(), which.end(), row.name) == which.end()) continue;
    const std::string option = option_of(row);
    const auto change = [&changes, &row, option](double value) { changes.push_back({&row, value, option}); };
    if (row.is_switch()) {
      const std::string no = "--no" + option.substr(1);
      options.push_back(command.add_flag_function(
          option + ",!" + no, [change](std::int64_t count) { change(count > 0 ? 1.0 : 0.0); }, row.words));
      options.back()->disable_flag_override(); // "--swept=on"
    } else {
      options.push_back(command.add_option_function<std::string>(
          option, [&row, change](const std::string& text) { change(*value_of(row, text)); }, row.words));
      options.back()->check([&row](const std::string& text) {
        return value_of(row, text) ? std::string() : fmt::format("found {}, expected {}", text, expected_of(row));
      });
      options.back()->option_text(
          row.is_choice() ? fmt::format("{{{}}}", fmt::join(row.names, ","))
                          : fmt::format("{} in [{} - {}]", row.has_fractions ? "FLOAT" : "INT", row.least, row.most));
    }
    options.back()->group("Settings, in place of the scene's");
  }
  return options;
}

} // namespace tutu::app
