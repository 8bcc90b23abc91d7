// Runs the built program as a user would.
#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <sys/wait.h>
#include <vector>

namespace tutu::test {

struct Outcome {
  int status = -1;    ///< exit status; 128 + signal when killed
  std::string output; ///< stdout and stderr, as they came
};

/// One argument of a shell command.
inline std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// `before`: shell text that goes before the program ("cd somewhere &&").
inline Outcome run_program(const std::vector<std::string>& arguments, const std::string& before = "") {
  std::string command = before + " " + quoted(TUTU_PROGRAM);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  Outcome outcome;
  std::FILE* pipe = ::popen(("{ " + command + "; } 2>&1 < /dev/null").c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> buffer{};
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.output.append(buffer.data(), got);
  const int status = ::pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

} // namespace tutu::test
