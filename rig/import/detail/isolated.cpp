#include "rig/import/detail/isolated.h"

#include "rig/error.h"
#include "rig/import/detail/archive.h"
#include "rig/import/import.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool k_sanitized = true; // takes several times the memory, and its messages must be seen
#else
constexpr bool k_sanitized = false;
#endif

namespace tutu::rig::import_detail {
namespace {

constexpr std::uintmax_t k_least_memory = std::uintmax_t{1} << 30; ///< bytes beyond what the program has already
constexpr std::uintmax_t k_memory_per_byte = 64;                   ///< of the file; Collada text needs about 20
constexpr std::uintmax_t k_least_seconds = 15;                     ///< of the processor; a body of 2 MB takes 0.1
constexpr std::uintmax_t k_bytes_per_second = 2'000'000;

enum class Answer : char { work = 'w', input_error = 'e', other_error = 'o' };

std::uintmax_t memory_in_use() {
  std::ifstream statm("/proc/self/statm");
  std::uintmax_t pages = 0;
  statm >> pages;
  return pages * static_cast<std::uintmax_t>(::sysconf(_SC_PAGESIZE));
}

void lower_limit(int resource, std::uintmax_t value) {
  rlimit limit{};
  if (::getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, value);
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

void bound_this_process(std::uintmax_t file_size) {
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_CPU, k_least_seconds + file_size / k_bytes_per_second);
  lower_limit(RLIMIT_AS, memory_in_use() + (k_sanitized ? 4 : 1) * (k_least_memory + k_memory_per_byte * file_size));
  if (k_sanitized) return;
  if (const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC); null >= 0) ::dup2(null, STDERR_FILENO); // assertions
}

/// The bytes to hand back: the answer's kind, then the answer.
std::string answer_of(const std::function<void(Packer&)>& work) {
  Packer packer;
  const auto kind = [&](Answer answer) {
    packer = Packer();
    packer.raw(&answer, sizeof answer);
  };
  try {
    kind(Answer::work);
    work(packer);
  } catch (const InputError& error) {
    kind(Answer::input_error);
    for (std::string part : {error.file(), error.place(), error.found(), error.expected()}) pass(packer, part);
  } catch (const std::exception& error) {
    kind(Answer::other_error);
    std::string what = error.what();
    pass(packer, what);
  }
  return packer.bytes();
}

void write_all(int descriptor, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    done += static_cast<std::size_t>(written);
  }
}

std::string read_all(int descriptor) {
  std::string bytes;
  char part[65536];
  for (;;) {
    const ssize_t got = ::read(descriptor, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return bytes;
    bytes.append(part, static_cast<std::size_t>(got));
  }
}

[[noreturn]] void run_child(int descriptor, std::uintmax_t file_size, const std::function<void(Packer&)>& work) {
  bound_this_process(file_size);
  try {
    write_all(descriptor, answer_of(work));
  } catch (...) { // not even memory for the message: the parent sees that nothing came
  }
  ::_exit(0);
}

std::string why(int status) {
  if (!WIFSIGNALED(status)) return "without an answer";
  const int signal = WTERMSIG(status);
  return signal == SIGXCPU || signal == SIGKILL ? "after too long a time" : "by signal " + std::to_string(signal);
}

/// A child that was led astray may have written anything.
void check(const Import& import, const std::string& file) {
  const Character& c = import.character;
  const std::size_t vertices = c.mesh.positions.size(),
                    slots = vertices * static_cast<std::size_t>(std::max(0, c.skin.influences));
  bool sound = (c.skin.influences == 4 || c.skin.influences == 8) && c.mesh.normals.size() == vertices &&
               c.skin.slots.size() == slots && c.skin.weights.size() == slots &&
               c.skin.inverse_bind.size() == c.skin.slot_joint.size() &&
               c.skeleton.parents.size() == c.skeleton.names.size() &&
               c.skeleton.rest_local.size() == c.skeleton.names.size();
  for (const int joint : c.skin.slot_joint) sound = sound && joint >= 0 && joint < c.skeleton.joint_count();
  for (const std::uint16_t slot : c.skin.slots) sound = sound && slot < c.skin.slot_joint.size();
  for (const Triangle& triangle : c.mesh.triangles)
    for (const std::uint32_t v : triangle) sound = sound && v < vertices;
  for (const MeshPart& part : c.mesh.parts)
    sound = sound && part.first_triangle <= c.mesh.triangles.size() &&
            part.triangle_count <= c.mesh.triangles.size() - part.first_triangle;
  if (!sound) throw InputError(file, "", "a file that leads its reader astray", "a rigged character");
  c.skeleton.check(file);
}

std::string bytes_of(const std::string& answer, int status, const std::string& file, const std::string& expected) {
  if (answer.empty())
    throw InputError(file, "", "a file that ends its reader " + why(status), expected + " that is not damaged");
  Unpacker unpacker(answer);
  Answer kind{};
  unpacker.raw(&kind, sizeof kind);
  if (kind == Answer::input_error) {
    std::string parts[4];
    for (std::string& part : parts) pass(unpacker, part);
    throw InputError(parts[0], parts[1], parts[2], parts[3]);
  }
  if (kind == Answer::other_error) {
    std::string what;
    pass(unpacker, what);
    throw std::runtime_error(what);
  }
  if (kind != Answer::work) throw std::runtime_error("the reader's answer is no answer");
  return answer.substr(sizeof kind);
}

} // namespace

std::string isolated_bytes(const std::string& file, std::uintmax_t file_size, const std::string& expected,
                           const std::function<void(Packer&)>& work) {
  std::fflush(nullptr);
  const auto unguarded = [&] {
    Packer packer;
    work(packer);
    return packer.bytes();
  };
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return unguarded();
  const pid_t child = ::fork();
  if (child < 0) { // no process to be had: better unguarded than not at all
    ::close(ends[0]);
    ::close(ends[1]);
    return unguarded();
  }
  if (child == 0) {
    ::close(ends[0]);
    run_child(ends[1], file_size, work);
  }
  ::close(ends[1]);
  std::string answer;
  try {
    answer = read_all(ends[0]);
  } catch (...) { // out of memory: leave no child behind
    ::close(ends[0]);
    ::waitpid(child, nullptr, 0);
    throw;
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return bytes_of(answer, status, file, expected);
}

Import isolated(const std::string& file, std::uintmax_t file_size, const std::function<Import()>& work) {
  const std::string bytes = isolated_bytes(file, file_size, "a rigged character", [&](Packer& packer) {
    Import import = work();
    pass(packer, import);
  });
  Unpacker unpacker(bytes);
  Import import;
  pass(unpacker, import);
  if (!unpacker.at_end()) throw std::runtime_error("the reader's answer is no answer");
  check(import, file);
  return import;
}

} // namespace tutu::rig::import_detail
