// Ctrl-C that leaves whole files.
#pragma once

#include <atomic>

namespace tutu::app {

/// From now on the first Ctrl-C (SIGINT) or SIGTERM only sets a flag, and the second ends the program as usual.
/// Calling it again clears the flag. Where nobody looks at the flag within k_interrupt_seconds the program ends by
/// itself: what was being written is as it was before, its temporaries are gone, and the status is 1.
void catch_interrupt();

inline constexpr double k_interrupt_seconds = 0.9;

/// True since the first Ctrl-C: finish the frame at hand, close the files, and return; from then on there is time.
bool interrupted();

/// The flag itself, for loops that take it from elsewhere (cloth::FrameInput::stop). Reading it grants no time.
const std::atomic<bool>& interrupt_flag();

} // namespace tutu::app
