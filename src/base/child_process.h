// Another program, started and waited for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
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

/// What it writes goes to files, for a pipe that nobody reads would stop it.
class ChildProcess {
public:
  /// `words[0]` is the program, found as a shell finds it; it reads nothing. Throws std::runtime_error when it cannot
  /// be started.
  explicit ChildProcess(std::vector<std::string> words);

  void interrupt() const; ///< as Ctrl-C would
  /// Nothing while it runs. Not to be asked again after it has answered.
  std::optional<ProcessEnd> ended();

private:
  std::filesystem::path output_, messages_;
  int pid_ = 0;
};

/// Starts it and waits.
ProcessEnd run_command(std::vector<std::string> words);

/// The last line of a text that is not empty; "" where there is none.
std::string last_line(const std::string& text);

} // namespace tutu::app
