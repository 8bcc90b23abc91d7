// What a command is going to write, looked at before it works: nothing that it reads is lost, and no hour's work ends
// at a folder that cannot be written to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tutu::app {

/// A file or folder that a command writes, and the option that named it.
struct Output {
  std::string option;
  std::filesystem::path path; ///< empty: not asked for
  bool is_folder = false;     ///< made, with those above it, when it is not there
};

/// Throws InputError for an output that is one of the inputs, by whatever name or link; for two that are one file; and
/// for one that cannot be written, with the system's reason. Removes what killed processes left where it will write.
void check_outputs(const std::vector<Output>& outputs, const std::vector<std::filesystem::path>& inputs);

/// A folder that one process works in at a time, until the lock is gone. Throws InputError when another has it.
class FolderLock {
public:
  /// `what`: who works there, for the message: "tutu chart".
  FolderLock(const std::filesystem::path& folder, const std::string& what);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

private:
  int descriptor_ = -1;
};

} // namespace tutu::app
