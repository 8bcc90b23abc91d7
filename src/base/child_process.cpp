#include "src/base/child_process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tutu::app {
namespace {

constexpr auto k_look_again = std::chrono::milliseconds(5);

/// A file that has no name.
int memory_file(const char* what) {
  const int descriptor = ::memfd_create(what, MFD_CLOEXEC);
  if (descriptor < 0) throw std::runtime_error(fmt::format("no memory for {}: {}", what, std::strerror(errno)));
  return descriptor;
}

void write_to(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t wrote = ::write(descriptor, text.data(), text.size());
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) throw std::runtime_error(std::string("no memory for a program's input: ") + std::strerror(errno));
    text.remove_prefix(static_cast<std::size_t>(wrote));
  }
  ::lseek(descriptor, 0, SEEK_SET);
}

std::string text_of(int descriptor) {
  const off_t size = ::lseek(descriptor, 0, SEEK_END);
  std::string text(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  const ssize_t got = ::pread(descriptor, text.data(), text.size(), 0);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return text;
}

void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

} // namespace

std::string ProcessEnd::last_message() const { return last_line(messages); }

ChildProcess::ChildProcess(std::vector<std::string> words, std::string_view input)
    : input_(memory_file("input")), output_(memory_file("output")), messages_(memory_file("messages")) {
  write_to(input_, input);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, input_, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, output_, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, messages_, STDERR_FILENO);
  const int error = ::posix_spawnp(&pid_, argv[0], &files, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (error == 0) return;
  for (int* descriptor : {&input_, &output_, &messages_}) close_if_open(*descriptor);
  throw std::runtime_error(fmt::format("{} cannot be started: {}", words[0], std::strerror(error)));
}

ChildProcess::~ChildProcess() {
  for (int* descriptor : {&input_, &output_, &messages_}) close_if_open(*descriptor);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept { *this = std::move(other); }

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  std::swap(input_, other.input_);
  std::swap(output_, other.output_);
  std::swap(messages_, other.messages_);
  std::swap(pid_, other.pid_);
  return *this;
}

void ChildProcess::interrupt() const { ::kill(pid_, SIGINT); }

std::optional<ProcessEnd> ChildProcess::ended() {
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return {};
  ProcessEnd end;
  if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
  else end.signal = WTERMSIG(status);
  end.output = text_of(output_);
  end.messages = text_of(messages_);
  return end;
}

ProcessEnd run_command(std::vector<std::string> words, std::string_view input) {
  ChildProcess child(std::move(words), input);
  for (;;) {
    if (auto end = child.ended()) return *std::move(end);
    std::this_thread::sleep_for(k_look_again);
  }
}

bool on_path(const char* program) {
  const char* path = std::getenv("PATH");
  std::string_view rest = path ? path : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    if (!folder.empty() && ::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  if (end == text.npos) return "";
  const std::size_t before = text.rfind('\n', end);
  const std::size_t begin = before == text.npos ? 0 : before + 1;
  return text.substr(begin, end - begin + 1);
}

} // namespace tutu::app
