// The commands of the program, one file each. A command adds its own options and its own work to the command line.
#pragma once

#include "src/options/program.h"

namespace tutu::app {

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
