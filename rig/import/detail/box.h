// Private to the importer: the box in which a process reads a foreign file.
//
// A reader may be led astray by the bytes it reads; what it can then do is what its process may do. Promised of a
// process that has called both functions below, by what the kernel keeps to whatever the process does:
//
// - Descriptors: none of the program's but the one its answer goes into; at most 16.
// - Limits, hard ones, which it cannot raise again: memory, seconds of the processor, no file grows, no core file, no
//   further process (NPROC binds everyone but root). It dies with the program.
// - No new rights (no_new_privs), no network, no other process or program, no signal to anyone else, nothing opened
//   for writing, made, renamed, removed, linked or changed, no mounts, no keys, no devices' controls: those calls
//   answer EPERM (seccomp; x86-64 and aarch64).
// - Reading: only the model and what is in its folder or below it (Landlock, where the kernel has it and has it
// switched
//   on). In any case the readers ask Reach before they open anything.
//
// Not promised: that it cannot see which files exist, nor what is in the memory it was forked with.
// Under a sanitizer its reports must get out: standard error stays, files may grow, Landlock is left out (they read
// /proc and the program itself), and memory is four times as much.
#pragma once

#include <cstdint>
#include <filesystem>

#if defined(__has_feature) // clang
#define TUTU_CHECKED_BY(sanitizer) __has_feature(sanitizer)
#else
#define TUTU_CHECKED_BY(sanitizer) 0
#endif

namespace tutu::rig::import_detail {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || TUTU_CHECKED_BY(address_sanitizer) ||             \
    TUTU_CHECKED_BY(thread_sanitizer) || TUTU_CHECKED_BY(memory_sanitizer)
inline constexpr bool k_sanitized = true;
#else
inline constexpr bool k_sanitized = false;
#endif

struct Bounds {
  std::uintmax_t memory;  ///< bytes beyond what the program has already
  std::uintmax_t seconds; ///< of the processor
};
/// For a file of this size, in bytes.
Bounds bounds_for(std::uintmax_t file_size);

/// Closes every descriptor but this one, which becomes the result; 0, 1 and 2 lead nowhere, and with them what the
/// readers print before they abort.
int keep_only(int descriptor);

/// Everything else that is promised, for this process from now on. Throws std::system_error when the kernel refuses a
/// guard it has: then nothing is to be read.
void close_box(const Bounds& bounds, const std::filesystem::path& model);

} // namespace tutu::rig::import_detail
