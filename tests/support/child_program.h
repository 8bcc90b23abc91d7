// The built program left running beside the test, and hands on its window (xdotool, on an X display).
#pragma once

#include <array>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

extern char** environ;

namespace tutu::test {

/// Runs from the constructor on; killed at the end if it still does.
class ChildProgram {
public:
  /// stdout and stderr go to `output`.
  ChildProgram(std::vector<std::string> arguments, const std::filesystem::path& output) {
    arguments.insert(arguments.begin(), TUTU_PROGRAM);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    if (::posix_spawn(&child_, TUTU_PROGRAM, &actions, nullptr, words.data(), environ) != 0) child_ = 0;
    posix_spawn_file_actions_destroy(&actions);
  }
  ~ChildProgram() {
    if (child_ != 0) end(SIGKILL);
  }
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  /// Sends a signal (0: none) and waits for the end. Exit status; 128 + signal when killed.
  int end(int signal) {
    if (child_ == 0) return -1;
    if (signal != 0) ::kill(child_, signal);
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

private:
  pid_t child_ = 0;
};

inline bool xdotool_available() { return std::system("command -v xdotool > /dev/null 2>&1") == 0; }

/// True when it did what it was told.
inline bool xdotool(const std::string& arguments) {
  return std::system(("xdotool " + arguments + " > /dev/null 2>&1").c_str()) == 0;
}

} // namespace tutu::test
