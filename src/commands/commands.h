// The commands of the program, one file each. A command adds its own options and its own work to the command line.
#pragma once

#include <CLI/CLI.hpp>

namespace tutu::app {

/// Exit statuses of the program.
inline constexpr int k_ok = 0;
inline constexpr int k_not_met = 1;   ///< a stated tolerance is not met, or the simulation diverged
inline constexpr int k_bad_input = 2; ///< bad usage or input

/// Each adds one subcommand to `app`; running it sets `status`.
void add_bench(CLI::App& app, int& status);
void add_cell(CLI::App& app, int& status);
void add_chart(CLI::App& app, int& status);
void add_drape(CLI::App& app, int& status);
void add_fit(CLI::App& app, int& status);
void add_inspect(CLI::App& app, int& status);
void add_mannequin(CLI::App& app, int& status);
void add_plan(CLI::App& app, int& status);
void add_play(CLI::App& app, int& status);
void add_pose(CLI::App& app, int& status);
void add_stability(CLI::App& app, int& status);
void add_validate(CLI::App& app, int& status);

} // namespace tutu::app
