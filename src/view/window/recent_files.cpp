#include "src/view/window/recent_files.h"

#include "rig/io/file_io.h"
#include "rig/text.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

fs::path list_file() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state) return fs::path(state) / "tutu" / "recent";
  if (const char* home = std::getenv("HOME"); home && *home)
    return fs::path(home) / ".local" / "state" / "tutu" / "recent";
  return {};
}

} // namespace

std::vector<std::string> recent_files() {
  std::vector<std::string> files;
  const fs::path list = list_file();
  std::error_code error;
  if (list.empty() || !fs::is_regular_file(list, error)) return files;
  std::istringstream lines(read_file(list));
  for (std::string line; files.size() < k_recent_files && std::getline(lines, line);)
    if (fs::is_regular_file(line, error)) files.push_back(line);
  return files;
}

void remember_file(const std::filesystem::path& file) {
  const fs::path list = list_file();
  if (list.empty()) return;
  try {
    const std::string path = fs::absolute(file).lexically_normal().string();
    if (!is_plain_text(path)) return; // a line each
    std::vector<std::string> files = recent_files();
    std::erase(files, path);
    files.insert(files.begin(), path);
    files.resize(std::min(files.size(), k_recent_files));
    std::string text;
    for (const std::string& each : files) text += each + "\n";
    fs::create_directories(list.parent_path());
    sweep_leftovers(list.parent_path());
    write_file(list, text);
  } catch (const std::exception&) { // a read-only home is no reason not to play
  }
}

} // namespace tutu::app
