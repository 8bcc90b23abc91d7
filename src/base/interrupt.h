// Ctrl-C that leaves whole files.
#pragma once

namespace tutu::app {

/// From now on the first Ctrl-C (SIGINT) or SIGTERM only sets a flag, and the second ends the program as usual.
/// Calling it again clears the flag.
void catch_interrupt();

/// True since the first Ctrl-C: finish the frame at hand, close the files, and return.
bool interrupted();

} // namespace tutu::app
