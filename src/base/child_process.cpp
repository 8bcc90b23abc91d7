#include "src/base/child_process.h"

#include "rig/io/file_io.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

constexpr auto k_look_again = std::chrono::milliseconds(5);

fs::path scratch_file(const char* what) {
  static std::atomic<int> count = 0;
  return fs::temp_directory_path() / fmt::format("tutu-{}-{}.{}", ::getpid(), ++count, what);
}

std::string take_file(const fs::path& file) {
  std::string text = fs::exists(file) ? read_file(file) : "";
  fs::remove(file);
  return text;
}

} // namespace

std::string ProcessEnd::last_message() const { return last_line(messages); }

ChildProcess::ChildProcess(std::vector<std::string> words)
    : output_(scratch_file("out")), messages_(scratch_file("err")) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, output_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, messages_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int error = ::posix_spawnp(&pid_, argv[0], &files, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (error == 0) return;
  fs::remove(output_);
  fs::remove(messages_);
  throw std::runtime_error(fmt::format("{} cannot be started: {}", words[0], std::strerror(error)));
}

void ChildProcess::interrupt() const { ::kill(pid_, SIGINT); }

std::optional<ProcessEnd> ChildProcess::ended() {
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return {};
  ProcessEnd end;
  if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
  else end.signal = WTERMSIG(status);
  end.output = take_file(output_);
  end.messages = take_file(messages_);
  return end;
}

ProcessEnd run_command(std::vector<std::string> words) {
  ChildProcess child(std::move(words));
  for (;;) {
    if (auto end = child.ended()) return *std::move(end);
    std::this_thread::sleep_for(k_look_again);
  }
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  if (end == text.npos) return "";
  const std::size_t before = text.rfind('\n', end);
  const std::size_t begin = before == text.npos ? 0 : before + 1;
  return text.substr(begin, end - begin + 1);
}

} // namespace tutu::app
