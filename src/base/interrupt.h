// Ctrl-C that leaves whole files.
#pragma once

#include <atomic>

namespace tutu::app {

/// From now on the first Ctrl-C (SIGINT) or SIGTERM only sets a flag, and the second ends the program as usual.
/// Calling it again clears the flag.
void catch_interrupt();

/// True since the first Ctrl-C: finish the frame at hand, close the files, and return.
bool interrupted();
const std::atomic<bool>& interrupt_flag(); ///< what it looks at, for who is to stop within a frame

} // namespace tutu::app
