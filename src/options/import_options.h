// How a character's file is to be read, on the command line.
#pragma once

#include "rig/import/import.h"

#include <CLI/CLI.hpp>

namespace tutu::app {

/// Adds --influences, --height, --unit and --rest; what is given is put in `import`, which must outlive the command.
void add_import_options(CLI::App& command, rig::ImportOptions& import);

} // namespace tutu::app
