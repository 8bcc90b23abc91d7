#include "src/base/outputs.h"

#include "rig/error.h"
#include "rig/io/file_io.h"

#include <cerrno>
#include <fcntl.h>
#include <span>
#include <sys/file.h>
#include <unistd.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

/// One file under two names, links followed; of files that are not there yet, one name.
bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::exists(a, error) && fs::exists(b, error)) return fs::equivalent(a, b, error) && !error;
  return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error) && !error;
}

/// Pipes and devices are simply written to, and may be named twice.
bool is_device(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

void check_folder(const Output& output) {
  std::error_code error;
  if (fs::exists(output.path, error) && !fs::is_directory(output.path, error))
    throw InputError(output.path.string(), output.option, "a file", "a folder, or a name that is not taken");
  fs::create_directories(output.path, error);
  if (error) throw InputError(output.path.string(), output.option, error.message(), "a folder that can be made");
  sweep_leftovers(output.path);
  (void)PendingFile(output.path / "probe"); // told now, not after the work
}

void check_file(const Output& output) {
  const fs::path folder = output.path.parent_path();
  sweep_leftovers(folder.empty() ? fs::path(".") : folder);
  try {
    (void)PendingFile(output.path);
  } catch (const InputError& error) {
    throw InputError(output.path.string(), output.option, error.found(), error.expected());
  } catch (const std::runtime_error& error) { // a folder that may not be written to, a disk that is full
    throw InputError(output.option + ": " + error.what(), "", "", "");
  }
}

} // namespace

void check_outputs(const std::vector<Output>& outputs, const std::vector<fs::path>& inputs) {
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const Output& output = outputs[k];
    if (output.path.empty() || is_device(output.path)) continue;
    if (output.is_folder) {
      check_folder(output);
      continue;
    }
    for (const fs::path& input : inputs)
      if (is_same(output.path, input))
        throw InputError(output.path.string(), output.option, "a file that is read (" + input.string() + ")",
                         "another name: it would be overwritten");
    for (const Output& other : std::span(outputs).first(k))
      if (!other.path.empty() && !other.is_folder && is_same(output.path, other.path))
        throw InputError(output.path.string(), output.option, "the file of " + other.option + " too", "one file each");
    check_file(output);
  }
}

FolderLock::FolderLock(const fs::path& folder, const std::string& what)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  // Where a file system knows no locks of folders there is nothing to say.
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw InputError(folder.string(), "", "another " + what + " at work in it", "it to end first, or another folder");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

} // namespace tutu::app
