#include "src/chart/cell_processes.h"

#include "rig/file_io.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

constexpr auto k_look_again = std::chrono::milliseconds(5); // short beside any cell

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  if (end == text.npos) return "";
  const std::size_t before = text.rfind('\n', end);
  return text.substr(before == text.npos ? 0 : before + 1, end - (before == text.npos ? 0 : before + 1) + 1);
}

/// One child. Its stderr goes to a file, for a pipe that nobody reads would stop it.
class Child {
public:
  Child(std::size_t index, const std::vector<std::string>& arguments)
      : index_(index), log_(fs::temp_directory_path() / fmt::format("tutu-{}-{}.log", ::getpid(), index)) {
    std::vector<std::string> words = {"tutu"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int error = ::posix_spawn(&pid_, "/proc/self/exe", &files, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&files);
    if (error != 0) throw std::runtime_error(std::string("no process can be started: ") + std::strerror(error));
  }

  std::size_t index() const { return index_; }
  void interrupt() const { ::kill(pid_, SIGINT); }

  /// Nothing while it runs.
  std::optional<ProcessEnd> ended() const {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) != pid_) return {};
    ProcessEnd end;
    if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
    else end.signal = WTERMSIG(status);
    end.message = last_line(read_file(log_));
    fs::remove(log_);
    return end;
  }

private:
  std::size_t index_;
  fs::path log_;
  pid_t pid_ = 0;
};

} // namespace

void run_processes(const std::vector<std::vector<std::string>>& arguments, int jobs,
                   const std::function<void(std::size_t, const ProcessEnd&)>& on_end,
                   const std::function<bool()>& go_on) {
  std::vector<Child> running;
  std::size_t next = 0;
  bool stopping = false;
  while (!running.empty() || (next < arguments.size() && !stopping)) {
    if (!stopping && !go_on()) {
      stopping = true;
      for (const Child& child : running) child.interrupt();
    }
    while (!stopping && next < arguments.size() && running.size() < static_cast<std::size_t>(jobs)) {
      running.emplace_back(next, arguments[next]);
      ++next;
    }
    for (std::size_t k = 0; k < running.size();) {
      if (const auto end = running[k].ended()) {
        const std::size_t index = running[k].index();
        running.erase(running.begin() + static_cast<std::ptrdiff_t>(k));
        on_end(index, *end);
      } else {
        ++k;
      }
    }
    std::this_thread::sleep_for(k_look_again);
  }
}

} // namespace tutu::app
