// A display of the test's own.
#pragma once

#include <array>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tutu::app {

/// An X server without a screen, and DISPLAY set to it, for as long as it lives.
class VirtualDisplay {
public:
  VirtualDisplay() {
    std::array<int, 2> pipe_ends{};
    if (::pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::array<std::string, 7> words = {"Xvfb", "-displayfd", "1", "-screen", "0", "800x600x24", "-noreset"};
    std::array<char*, 8> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
    const bool started = ::posix_spawnp(&server_, "Xvfb", &actions, nullptr, arguments.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipe_ends[1]);
    if (!started) server_ = 0;
    if (const std::string number = started ? first_line(pipe_ends[0]) : ""; !number.empty()) {
      const char* before = std::getenv("DISPLAY");
      before_ = before ? before : "";
      ::setenv("DISPLAY", (":" + number).c_str(), 1);
      running_ = true;
    }
    ::close(pipe_ends[0]);
  }
  ~VirtualDisplay() {
    if (running_) before_.empty() ? ::unsetenv("DISPLAY") : ::setenv("DISPLAY", before_.c_str(), 1);
    if (server_ == 0) return;
    ::kill(server_, SIGTERM);
    ::waitpid(server_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  bool running() const { return running_; }

private:
  /// Up to the line's end, since the server dies of a pipe closed before; "" when none comes.
  static std::string first_line(int descriptor) {
    std::string line;
    for (char next = 0;;) {
      pollfd readable{.fd = descriptor, .events = POLLIN, .revents = 0};
      if (::poll(&readable, 1, 20000) != 1 || ::read(descriptor, &next, 1) != 1) return "";
      if (next == '\n') return line;
      line += next;
    }
  }

  pid_t server_ = 0;
  bool running_ = false;
  std::string before_;
};

} // namespace tutu::app
