// Private to the importer: reading in a process of its own.
//
// assimp 5.2.5 can be made to crash, abort or eat all memory by a file with a few wrong bytes (found by flipping bytes;
// Debian's build keeps its assertions), and what it overwrites before it crashes would be ours. So a child process with
// bounded memory and time reads the file and hands back the finished Import; only that is believed, after a check.
#pragma once

#include "rig/character.h"
#include "rig/import/detail/archive.h"

#include <functional>
#include <string>

namespace tutu::rig::import_detail {

/// What `work` packs, in bytes. Throws the InputError that `work` throws, and InputError naming `file` and what was
/// `expected` of it when the child dies. `file_size` (bytes) grants memory and time beyond the least. The bytes come
/// from a process that may have been led astray: to be checked before they are believed.
std::string isolated_bytes(const std::string& file, std::uintmax_t file_size, const std::string& expected,
                           const std::function<void(Packer&)>& work);

/// The Import that `work` returns, checked.
Import isolated(const std::string& file, std::uintmax_t file_size, const std::function<Import()>& work);

} // namespace tutu::rig::import_detail
