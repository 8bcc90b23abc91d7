#include "rig/import/detail/box.h"

#include "rig/import/detail/refused_calls.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <system_error>
#include <unistd.h>

namespace tutu::rig::import_detail {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t k_least_memory = std::uintmax_t{1} << 30; ///< bytes
constexpr std::uintmax_t k_memory_per_byte = 64;                   ///< of the file; Collada text needs about 20
constexpr std::uintmax_t k_least_seconds = 15;                     ///< a body of 2 MB takes 0.1
constexpr std::uintmax_t k_bytes_per_second = 2'000'000;
constexpr rlim_t k_most_descriptors = 16; ///< the model, a buffer of it, and the four it starts with

std::uintmax_t memory_in_use() {
  std::ifstream statm("/proc/self/statm");
  std::uintmax_t pages = 0;
  statm >> pages;
  return pages * static_cast<std::uintmax_t>(::sysconf(_SC_PAGESIZE));
}

/// At `soft` the process is told, at `hard` it has no choice; both only ever fall.
void lower_limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  rlimit limit{};
  ::getrlimit(resource, &limit);
  limit.rlim_max = std::min(limit.rlim_max, hard);
  limit.rlim_cur = std::min({limit.rlim_cur, limit.rlim_max, soft});
  if (::setrlimit(resource, &limit) != 0) throw std::system_error(errno, std::generic_category(), "setrlimit");
}
void lower_limit(__rlimit_resource resource, rlim_t value) { lower_limit(resource, value, value); }

/// Landlock's calls have no names in the C library.
void read_only_below(const fs::path& model) {
  landlock_ruleset_attr everything{};
  everything.handled_access_fs = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1; // all that its first version knows
  const auto rules =
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &everything, sizeof everything, std::uint32_t{0}));
  if (rules < 0) return; // a kernel without it
  for (const fs::path& allowed : {fs::absolute(model).parent_path(), model}) {
    landlock_path_beneath_attr rule{};
    rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
    rule.parent_fd = ::open(allowed.c_str(), O_PATH | O_CLOEXEC);
    const bool added = rule.parent_fd >= 0 && ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule,
                                                        std::uint32_t{0}) == 0;
    if (!added) throw std::system_error(errno, std::generic_category(), "landlock_add_rule");
    ::close(rule.parent_fd);
  }
  if (::syscall(SYS_landlock_restrict_self, rules, std::uint32_t{0}) != 0)
    throw std::system_error(errno, std::generic_category(), "landlock_restrict_self");
  ::close(rules);
}

} // namespace

Bounds bounds_for(std::uintmax_t file_size) {
  return {(k_sanitized ? 4 : 1) * (k_least_memory + k_memory_per_byte * file_size),
          k_least_seconds + file_size / k_bytes_per_second};
}

int keep_only(int descriptor) {
  constexpr int k_kept = STDERR_FILENO + 1;
  ::dup2(descriptor, k_kept); // first: it may be one of those below
  ::closefrom(k_kept + 1);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if ((standard != STDERR_FILENO || !k_sanitized) && ::dup2(nowhere, standard) < 0) ::close(standard);
  if (nowhere > k_kept) ::close(nowhere);
  return k_kept;
}

void close_box(const Bounds& bounds, const fs::path& model) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  lower_limit(RLIMIT_AS, memory_in_use() + bounds.memory);
  lower_limit(RLIMIT_CPU, bounds.seconds, bounds.seconds + 1);
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_NPROC, 0);
  lower_limit(RLIMIT_NOFILE, k_most_descriptors);
  if (!k_sanitized) lower_limit(RLIMIT_FSIZE, 0);
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
    throw std::system_error(errno, std::generic_category(), "no_new_privs");
  if (!k_sanitized) read_only_below(model);
  refuse_calls();
}

} // namespace tutu::rig::import_detail
