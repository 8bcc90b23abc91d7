// How far long work is, on stderr.
#pragma once

#include <chrono>
#include <string>

namespace tutu::app {

/// On a terminal a bar that is drawn in place, else one line each 10 %: label, count, rate and time left.
class Progress {
public:
  /// Draws nothing for total <= 0.
  Progress(std::string label, int total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void tick(int done); ///< of total, since the start; cheap enough for every frame
  void finish();       ///< ends the line; later ticks draw nothing

private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  int total_;
  bool terminal_, finished_ = false;
  Clock::time_point start_, last_drawn_;
  int tenths_drawn_ = 0, last_done_ = 0;
};

/// "dance  [#####.....]  150/300   24.6/s   6 s left", without the bar for `bar_width` 0.
std::string progress_line(const std::string& label, int done, int total, double seconds, int bar_width);

} // namespace tutu::app
