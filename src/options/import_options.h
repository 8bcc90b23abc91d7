// How a character's file is to be read, on the command line.
#pragma once

#include "rig/import/import.h"

#include <CLI/CLI.hpp>
#include <string>

namespace tutu::app {

/// Adds --influences, --height (by another name where a command means pictures by it), --unit and --rest; what is given
/// is put in `import`, which must outlive the command.
void add_import_options(CLI::App& command, rig::ImportOptions& import, const std::string& height_option = "--height");

} // namespace tutu::app
