#include "rig/import/detail/isolated.h"

#include "rig/error.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <new>
#include <poll.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace tutu::rig::import_detail {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uintmax_t k_patience = 20; ///< seconds to wait for each of the processor's: others may have it
constexpr int k_no_memory_for_answer = 3; ///< exit status

/// A descriptor, closed when this goes.
class Descriptor {
public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

private:
  int number_;
};

/// A child process; none is left behind when this goes.
class Child {
public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (process_ > 0) end();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Ends it if it has not ended; its status.
  int end() {
    ::kill(process_, SIGKILL); // changes nothing for one that is about to exit
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return status;
  }

private:
  pid_t process_;
};

void write_all(int descriptor, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    done += static_cast<std::size_t>(written);
  }
}

/// All that comes until the other end is closed. Throws InputError when it takes too long or is more than `bounds`
/// allow anyone to have in memory.
std::string read_all(int descriptor, const Bounds& bounds, const std::string& file, const std::string& expected) {
  const auto deadline = Clock::now() + std::chrono::seconds(k_patience * bounds.seconds);
  std::string bytes;
  char part[65536];
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd ready = {descriptor, POLLIN, 0};
    const int events = left > 0 ? ::poll(&ready, 1, static_cast<int>(std::min<long>(left, 1 << 30))) : 0;
    if (events < 0 && errno == EINTR) continue;
    if (events == 0) throw InputError(file, "", "a file whose reader falls silent", expected + " that is not damaged");
    const ssize_t got = ::read(descriptor, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return bytes;
    bytes.append(part, static_cast<std::size_t>(got));
    if (bytes.size() > bounds.memory)
      throw InputError(file, "", "a file whose reader answers without end", expected + " that is not damaged");
  }
}

[[noreturn]] void run_child(int descriptor, const std::string& file, const Bounds& bounds,
                            const std::function<void(Packer&)>& work) {
  const int pipe = keep_only(descriptor);
  try {
    write_all(pipe, answer_of([&](Packer& packer) {
                close_box(bounds, file);
                work(packer);
              }));
  } catch (...) { // not even memory for the message
    ::_exit(k_no_memory_for_answer);
  }
  ::_exit(0);
}

std::string why(int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == k_no_memory_for_answer) return "for want of memory";
  if (!WIFSIGNALED(status)) return "without an answer";
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU) return "after too long a time";
  return "by signal " + std::to_string(signal) + (signal == SIGKILL ? ", as when the machine has no memory left" : "");
}

} // namespace

std::string isolated_answer(const std::string& file, const Bounds& bounds, const std::string& expected,
                            const std::function<void(Packer&)>& work) {
  std::fflush(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "no pipe to a process that reads it");
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  const pid_t process = ::fork();
  if (process < 0) throw std::system_error(errno, std::generic_category(), "no process to read it in");
  if (process == 0) run_child(to.number(), file, bounds, work);
  Child child(process);
  to.close();
  std::string answer = read_all(from.number(), bounds, file, expected);
  if (const int status = child.end(); status != 0 || answer.empty())
    throw InputError(file, "", "a file that ends its reader " + why(status), expected + " that is not damaged");
  return answer;
}

void rethrow_as_input_error(const std::string& file, const std::string& expected) {
  try {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(file, "", "a file that takes more memory to read than there is", expected);
  } catch (const std::exception& error) { // sizes a hostile file claims, and whatever assimp throws
    throw InputError(file, "", std::string("a file that cannot be read (") + error.what() + ")", expected);
  }
}

} // namespace tutu::rig::import_detail
