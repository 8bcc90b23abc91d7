#include "rig/io/file_io.h"

#include "rig/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <system_error>
#include <unistd.h>

namespace tutu {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t k_largest_input = std::uintmax_t{1} << 30; // bytes; a character is some megabytes

[[noreturn]] void fail(const fs::path& file, const char* what) {
  throw std::runtime_error(file.string() + ": " + what + ": " + std::strerror(errno));
}

/// Nothing yet, or a plain file: what a rename may put itself in the place of. A pipe or a device may not be lost.
bool is_replaceable(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  return !fs::exists(status) || fs::is_regular_file(status);
}

void flush_to_disk(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(file, "cannot be opened to flush");
  const int result = ::fsync(descriptor);
  ::close(descriptor);
  if (result != 0) fail(file, "cannot be flushed");
}

} // namespace

std::string read_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError(file.string(), "", "no such file", "a readable file");
  if (!fs::is_regular_file(status))
    throw InputError(file.string(), "", "something that is not a file", "a readable file");
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error && size > k_largest_input)
    throw InputError(file.string(), "", std::to_string(size) + " bytes", "at most 1 GiB");
  std::ifstream in(file, std::ios::binary);
  std::string bytes;
  if (in) {
    bytes.resize(error ? 0 : size);
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(in.gcount()));
  }
  if (!in) throw InputError(file.string(), "", "a file that cannot be read", "a readable file");
  return bytes;
}

PendingFile::PendingFile(fs::path target) : target_(std::move(target)) {
  std::error_code error;
  if (fs::is_symlink(target_, error)) target_ = fs::weakly_canonical(target_); // the link stays, its file is replaced
  if (!is_replaceable(target_))
    throw InputError(target_.string(), "", "something that is not a file", "a file to write");
  if (!target_.parent_path().empty() && !fs::is_directory(target_.parent_path(), error))
    throw InputError(target_.string(), "", "no folder " + target_.parent_path().string(), "an existing folder");
  // Hidden, in the same folder (a rename must not cross file systems), with the extension kept for tools that look at
  // it.
  temporary_ = target_.parent_path() / ("." + target_.stem().string() + "." + std::to_string(::getpid()) + ".part" +
                                        target_.extension().string());
}

PendingFile::~PendingFile() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void PendingFile::commit() {
  flush_to_disk(temporary_);
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(target_, "cannot be written");
  committed_ = true;
}

void write_file(const fs::path& file, std::string_view bytes) {
  if (!is_replaceable(file) && !fs::is_directory(file)) { // a pipe or a device: there is nothing to leave half-written
    std::ofstream out(file, std::ios::binary);
    if (!out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush()) fail(file, "cannot be written");
    return;
  }
  PendingFile pending(file);
  std::ofstream out(pending.temporary(), std::ios::binary | std::ios::trunc);
  if (!out) fail(file, "cannot be written");
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) fail(file, "cannot be written");
  pending.commit();
}

} // namespace tutu
