// How much memory something takes at the most, as the system counts it.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <malloc.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace tutu::test {

/// Of /proc/self/status, in bytes; 0 where there is none.
inline double memory_now(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key + ":")) return 1024.0 * std::stod(line.substr(key.size() + 1));
  return 0.0;
}

/// Bytes by which the process is larger at the most while it does this, in a child of its own that starts out small.
template <class Work> double peak_memory_of(const Work& work) {
  int ends[2];
  if (::pipe(ends) != 0) return -1.0;
  std::fflush(nullptr); // what is not written yet would be written twice
  const pid_t child = ::fork();
  if (child == 0) {
    ::malloc_trim(0);                            // what earlier work gave back would be taken without being seen
    std::ofstream("/proc/self/clear_refs") << 5; // the peak is what there is now
    const double before = memory_now("VmRSS");
    work();
    const double taken = memory_now("VmHWM") - before;
    const bool written = ::write(ends[1], &taken, sizeof taken) == sizeof taken;
    ::_exit(written ? 0 : 1);
  }
  ::close(ends[1]);
  double taken = -1.0;
  if (::read(ends[0], &taken, sizeof taken) != sizeof taken) taken = -1.0;
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return taken;
}

/// Sets an environment variable for as long as it lives; null: none of that name.
class Variable {
public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before, had_ = true;
    if (value) ::setenv(name, value, 1);
    else ::unsetenv(name);
  }
  ~Variable() {
    if (had_) ::setenv(name_, before_.c_str(), 1);
    else ::unsetenv(name_);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

private:
  const char* name_;
  std::string before_;
  bool had_ = false;
};

} // namespace tutu::test
