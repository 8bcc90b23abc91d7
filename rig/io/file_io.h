// Reading whole files, and writing them so that a reader never sees half of one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tutu {

/// The bytes of a file. Throws InputError when it is missing, a folder, unreadable, or larger than 1 GiB.
std::string read_file(const std::filesystem::path& file);

/// Writes to a temporary name beside `file`, flushes it to disk, then renames: `file` is the old one or the
/// whole new one, never a part. Follows a symbolic link; a pipe or a device is simply written to. Throws InputError
/// when it cannot be a file (a folder, in no folder, or with a name that is too long), else std::runtime_error with the
/// system's reason; leaves no temporary.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// For writers that need a path of their own (a video encoder, say): write to `temporary()`, then `commit()`.
/// Without a commit the temporary is removed. It exists and is empty from the start, under a name that nobody could
/// have known, so that no link can lie in wait there. Throws as write_file.
class PendingFile {
public:
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  void commit();

private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

/// Removes the temporaries that processes of this machine left in a folder when they were killed.
void sweep_leftovers(const std::filesystem::path& folder);

/// Removes the temporaries of this process; nothing may be written any more. For a signal's handler on the way out:
/// safe there.
void abandon_pending_files() noexcept;

} // namespace tutu
