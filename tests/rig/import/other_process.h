// What a function says in a process of its own: for limits that must not stay, and for whatever might end it.
#pragma once

#include "rig/error.h"

#include <functional>
#include <string>
#include <sys/inotify.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace tutu::test {

/// The message of the InputError that `work` throws, "" when it throws none, "?" and the message of any other error.
inline std::string message_in_process(const std::function<void()>& work) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    std::string message;
    try {
      work();
    } catch (const InputError& error) {
      message = error.what();
    } catch (const std::exception& error) {
      message = std::string("?") + error.what();
    }
    const bool written = ::write(ends[1], message.data(), message.size()) == static_cast<ssize_t>(message.size());
    ::_exit(written ? 0 : 1);
  }
  ::close(ends[1]);
  std::string message;
  char part[4096];
  for (ssize_t got; (got = ::read(ends[0], part, sizeof part)) > 0;)
    message.append(part, static_cast<std::size_t>(got));
  ::close(ends[0]);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << message;
  return message;
}

/// Sees whether anyone opens a file.
class Watch {
public:
  explicit Watch(const std::string& file) : descriptor_(::inotify_init1(IN_NONBLOCK)) {
    EXPECT_GE(::inotify_add_watch(descriptor_, file.c_str(), IN_OPEN), 0) << file;
  }
  ~Watch() { ::close(descriptor_); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// Since the last time it was asked.
  bool saw_it_opened() {
    alignas(inotify_event) char events[4096];
    return ::read(descriptor_, events, sizeof events) > 0;
  }

private:
  int descriptor_;
};

} // namespace tutu::test
