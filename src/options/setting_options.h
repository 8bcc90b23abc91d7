// Settings of a run on the command line, an option each.
#pragma once

#include "src/run/settings_table.h"

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace tutu::app {

/// Adds the options of these settings (all of them, where none is named) to a command, in a group of their own: a
/// number or a choice takes a value, a switch is --name or --no-name. What is given is added to `changes`, which must
/// outlive the command. Returns the options.
std::vector<CLI::Option*> add_setting_options(CLI::App& command, std::vector<SettingChange>& changes,
                                              std::initializer_list<std::string_view> which = {});

} // namespace tutu::app
