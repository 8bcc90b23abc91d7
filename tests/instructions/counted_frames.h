// Where counting of instructions begins and ends.
#pragma once

#include <functional>

/// Calls `frame` so many times. Valgrind is told of it by this very name: a function of the product could be inlined
/// or renamed, and what loads a scene is outside of it. In a file of its own, or the compiler calls a copy of it that
/// knows its arguments, under another name.
extern "C" void tutu_counted_frames(const std::function<void()>& frame, int frames);
