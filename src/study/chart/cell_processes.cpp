#include "src/study/chart/cell_processes.h"

#include <chrono>
#include <thread>

namespace tutu::app {
namespace {

constexpr auto k_look_again = std::chrono::milliseconds(5); // short beside any cell

ChildProcess start(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"/proc/self/exe"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return ChildProcess(std::move(words));
}

} // namespace

void run_processes(const std::vector<std::vector<std::string>>& arguments, int jobs, const OnEnd& on_end,
                   const std::function<bool()>& go_on) {
  std::vector<std::pair<std::size_t, ChildProcess>> running;
  std::size_t next = 0;
  bool stopping = false;
  while (!running.empty() || (next < arguments.size() && !stopping)) {
    if (!stopping && !go_on()) {
      stopping = true;
      for (const auto& [index, child] : running) child.interrupt();
    }
    while (!stopping && next < arguments.size() && running.size() < static_cast<std::size_t>(jobs)) {
      running.emplace_back(next, start(arguments[next]));
      ++next;
    }
    for (std::size_t k = 0; k < running.size();) {
      if (const auto end = running[k].second.ended()) {
        const std::size_t index = running[k].first;
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
