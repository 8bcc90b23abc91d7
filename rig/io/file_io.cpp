#include "rig/io/file_io.h"

#include "rig/error.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
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

/// What temporaries of this machine are called, up to the process: folders may be shared between machines.
const std::string& machine_prefix() {
  static const std::string prefix = [] {
    char name[256] = {};
    ::gethostname(name, sizeof name - 1);
    std::uint64_t hash = 14695981039346656037ull; // FNV-1a [Fowler, Noll, Vo 1991]
    for (const char* c = name; *c != 0; ++c) hash = (hash ^ static_cast<unsigned char>(*c)) * 1099511628211ull;
    char text[24];
    std::snprintf(text, sizeof text, "%08x", static_cast<unsigned>(hash ^ hash >> 32));
    return ".tutu-" + std::string(text) + "-";
  }();
  return prefix;
}

std::string own_prefix() { return machine_prefix() + std::to_string(::getpid()) + "-"; }

mode_t file_mask() {
  static const mode_t mask = [] { // can only be asked by setting it: once
    const mode_t old = ::umask(0);
    ::umask(old);
    return old;
  }();
  return mask;
}

/// The names of this process's temporaries, where a signal's handler can read them. A handler can reach nothing but a
/// global; what finds no room is swept at a later start.
class PendingNames {
public:
  void add(const char* name) {
    const std::size_t length = std::strlen(name);
    for (Slot& slot : slots_) {
      int free = k_free;
      if (length >= sizeof slot.name || !slot.state.compare_exchange_strong(free, k_taken)) continue;
      std::memcpy(slot.name, name, length + 1);
      slot.state = k_full;
      return;
    }
  }
  void remove(const char* name) {
    for (Slot& slot : slots_)
      if (slot.state == k_full && std::strcmp(slot.name, name) == 0) slot.state = k_free;
  }
  void remove_all() noexcept {
    for (Slot& slot : slots_)
      if (slot.state == k_full) ::unlink(slot.name);
  }

private:
  static constexpr int k_free = 0, k_taken = 1, k_full = 2;
  struct Slot {
    std::atomic<int> state = k_free;
    char name[4096] = {};
  };
  Slot slots_[16];
};
static_assert(std::atomic<int>::is_always_lock_free);
PendingNames g_pending;

} // namespace

std::string read_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) // a loop of links, a name that is too long, a file where a folder should be: its reason
    throw InputError(file.string(), "",
                     error && error != std::errc::no_such_file_or_directory ? error.message() : "no such file",
                     "a readable file");
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
  if (fs::is_symlink(target_, error)) { // the link stays, its file is replaced
    target_ = fs::weakly_canonical(target_, error);
    if (error)
      throw InputError(target_.string(), "", "a link that leads nowhere: " + error.message(), "a file to write");
  }
  if (!is_replaceable(target_))
    throw InputError(target_.string(), "", "something that is not a file", "a file to write");
  const fs::path folder = target_.parent_path().empty() ? fs::path(".") : target_.parent_path();
  if (!fs::is_directory(folder, error))
    throw InputError(target_.string(), "", "no folder " + folder.string(), "an existing folder");
  const long longest = ::pathconf(folder.c_str(), _PC_NAME_MAX);
  if (const std::size_t length = target_.filename().string().size(); longest > 0 && length > std::size_t(longest))
    throw InputError(target_.string(), "", "a name of " + std::to_string(length) + " bytes",
                     "at most " + std::to_string(longest));
  // Hidden, in the same folder (a rename must not cross file systems), with the extension kept for tools that look at
  // it.
  const std::string extension = target_.extension().string().size() < 32 ? target_.extension().string() : "";
  std::string name = (folder / (own_prefix() + "XXXXXX" + extension)).string();
  const int descriptor = ::mkostemps(name.data(), static_cast<int>(extension.size()), O_CLOEXEC);
  if (descriptor < 0) fail(target_, "cannot be written");
  temporary_ = name;
  g_pending.add(temporary_.c_str());
  struct stat old {};
  const mode_t mode = ::stat(target_.c_str(), &old) == 0 ? old.st_mode & 0777u : 0666u & ~file_mask();
  ::fchmod(descriptor, mode); // else it would stay nobody's but the owner's
  ::close(descriptor);
}

PendingFile::~PendingFile() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  g_pending.remove(temporary_.c_str());
}

void PendingFile::commit() {
  flush_to_disk(temporary_);
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(target_, "cannot be written");
  g_pending.remove(temporary_.c_str());
  committed_ = true;
}

void sweep_leftovers(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(machine_prefix())) continue;
    const int owner = std::atoi(name.c_str() + machine_prefix().size());
    std::error_code ignored;
    if (owner > 0 && ::kill(owner, 0) != 0 && errno == ESRCH) fs::remove(entry->path(), ignored);
  }
}

void abandon_pending_files() noexcept { g_pending.remove_all(); }

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
