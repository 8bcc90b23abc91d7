// Files that were played lately, across runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tutu::app {

inline constexpr std::size_t k_recent_files = 8;

/// Newest first, those that are still there. They are kept in $XDG_STATE_HOME/tutu/recent, else
/// ~/.local/state/tutu/recent.
std::vector<std::string> recent_files();

/// Puts the file at the front. Where that cannot be written it is not remembered.
void remember_file(const std::filesystem::path& file);

} // namespace tutu::app
