// What every program of the house does around its commands: exit statuses, and errors as one message.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace tutu::app {

/// Exit statuses.
inline constexpr int k_ok = 0;
inline constexpr int k_not_met = 1;   ///< a stated tolerance is not met, or the simulation diverged
inline constexpr int k_bad_input = 2; ///< bad usage or input

/// Parses and runs. `status` is what the command that ran has set; what is thrown becomes a message and k_bad_input.
int run_program(CLI::App& app, int argc, const char* const* argv, const int& status);
/// The same with the words of a JSON file (a list of strings) for arguments.
int run_program_on_file(CLI::App& app, const std::filesystem::path& file, const int& status);

/// The last line of a run, on stderr and after all that went to stdout: "tutu: warning: ...". Nothing for "".
void print_warning(const std::string& warning);

} // namespace tutu::app
