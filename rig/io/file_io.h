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
/// when it cannot be a file (a folder, or in no folder), else std::runtime_error with the system's reason; leaves no
/// temporary.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// For writers that need a path of their own (a video encoder, say): write to `temporary()`, then `commit()`.
/// Without a commit the temporary is removed.
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

} // namespace tutu
