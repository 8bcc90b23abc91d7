// Private to the importer: reading in a process of its own.
//
// assimp 5.2.5 can be made to crash, abort or eat all memory by a file with a few wrong bytes (found by flipping bytes;
// Debian's build keeps its assertions), and what it overwrites before it crashes would be ours. So a child process in a
// box (box.h) reads the file and hands back what it made of it; only that is believed, after a check of every value.
#pragma once

#include "rig/character.h"
#include "rig/import/detail/archive.h"
#include "rig/import/detail/box.h"

#include <functional>
#include <string>
#include <string_view>

namespace tutu::rig::import_detail {

/// The bytes a reader hands over: what became of it, then what `work` packed or the error it threw.
std::string answer_of(const std::function<void(Packer&)>& work);

/// The answer of a process that does `work` in a box around `file`. Throws InputError naming `file` and what was
/// `expected` of it when the process dies, falls silent or does not stop answering, and std::system_error when there is
/// no pipe or no process to be had: nothing is read without one.
std::string isolated_answer(const std::string& file, const Bounds& bounds, const std::string& expected,
                            const std::function<void(Packer&)>& work);

/// What an answer holds, checked value by value: the process that gave it may have been led astray. Throws the
/// InputError that the answer tells of, InputError naming `file` on values that cannot be, std::runtime_error on bytes
/// that are no answer.
Import unpack_import(std::string_view answer, const std::string& file);
TriangleSurface unpack_surface(std::string_view answer, const std::string& file);

/// Inside a catch clause: an InputError as it is, anything else as one that names `file`.
[[noreturn]] void rethrow_as_input_error(const std::string& file, const std::string& expected);

inline constexpr const char* k_expected_character = "a rigged character";
inline constexpr const char* k_expected_surface = "a surface of finite triangles";

} // namespace tutu::rig::import_detail
