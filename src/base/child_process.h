// Another program, started and waited for.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::app {

/// How one ended.
struct ProcessEnd {
  int status = 0;       ///< exit status, or
  int signal = 0;       ///< the signal that killed it
  std::string output;   ///< what it wrote to stdout
  std::string messages; ///< and to stderr

  bool good() const { return status == 0 && signal == 0; }
  std::string last_message() const; ///< the last line of `messages`
};

/// What it reads and writes is memory: a pipe that nobody reads would stop it, and a file could be left behind.
class ChildProcess {
public:
  /// `words[0]` is the program, found as a shell finds it; it reads `input`. Throws std::runtime_error when it cannot
  /// be started.
  explicit ChildProcess(std::vector<std::string> words, std::string_view input = {});
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  void interrupt() const; ///< as Ctrl-C would
  /// Nothing while it runs. Not to be asked again after it has answered.
  std::optional<ProcessEnd> ended();

private:
  int input_ = -1, output_ = -1, messages_ = -1; ///< descriptors
  int pid_ = 0;
};

/// Starts it and waits.
ProcessEnd run_command(std::vector<std::string> words, std::string_view input = {});

/// Whether a program is to be had, as a shell finds it.
bool on_path(const char* program);

/// The last line of a text that is not empty; "" where there is none.
std::string last_line(const std::string& text);

} // namespace tutu::app
