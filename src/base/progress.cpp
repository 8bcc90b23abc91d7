#include "src/base/progress.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

namespace tutu::app {
namespace {

constexpr auto k_redraw = std::chrono::milliseconds(100);
constexpr int k_bar_width = 30; // characters

std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::clamp(seconds, 0.0, 1e8)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

} // namespace

std::string progress_line(const std::string& label, int done, int total, double seconds, int bar_width) {
  done = std::clamp(done, 0, total);
  std::string line = label;
  if (bar_width > 0) {
    const auto filled = static_cast<std::size_t>(static_cast<long>(bar_width) * done / total);
    line += "  [" + std::string(filled, '#') + std::string(static_cast<std::size_t>(bar_width) - filled, '.') + "]";
  }
  line += fmt::format("  {:{}}/{}", done, std::to_string(total).size(), total);
  if (done > 0 && seconds > 0) {
    const double rate = done / seconds;
    line += fmt::format("  {:.1f}/s  ", rate);
    line += done < total ? duration((total - done) / rate) + " left" : duration(seconds);
  }
  return line;
}

Progress::Progress(std::string label, int total)
    : label_(std::move(label)), total_(total), terminal_(::isatty(STDERR_FILENO) == 1), start_(Clock::now()),
      last_drawn_(start_ - k_redraw) {}

Progress::~Progress() { finish(); }

void Progress::tick(int done) {
  if (finished_ || total_ <= 0) return;
  last_done_ = done;
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (terminal_) {
    if (now - last_drawn_ < k_redraw && done < total_) return;
    last_drawn_ = now;
    // Back to the line's start, and what an earlier, longer line left is cleared.
    fmt::print(stderr, "\r{}\x1b[K", progress_line(label_, done, total_, seconds, k_bar_width));
    std::fflush(stderr);
  } else if (const int tenths = static_cast<int>(10L * done / total_); tenths > tenths_drawn_) {
    tenths_drawn_ = tenths;
    fmt::print(stderr, "{}\n", progress_line(label_, done, total_, seconds, 0));
  }
}

void Progress::finish() {
  if (finished_) return;
  finished_ = true;
  if (terminal_ && total_ > 0 && last_done_ > 0) fmt::print(stderr, "\n");
}

} // namespace tutu::app
