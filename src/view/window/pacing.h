// How many steps of the simulation a drawn frame owes.
#pragma once

#include <algorithm>

namespace tutu::app {

/// Turns the clock's time into whole steps. What cannot be caught up is forgotten: a slow machine plays slower, and
/// stays responsive, instead of falling ever further behind.
class Pacing {
public:
  /// `elapsed`: s of the clock since the last call; `scale`: simulated seconds per second of the clock;
  /// `step`: s, > 0. Returns 0 .. most.
  int steps_due(double elapsed, double scale, double step, int most) {
    debt_ += std::max(0.0, elapsed * scale) / step;
    const int due = static_cast<int>(std::min<double>(debt_ + k_rounding, most));
    debt_ = std::clamp(debt_ - due, 0.0, 1.0);
    return due;
  }
  void forget() { debt_ = 0; } ///< after a pause or a jump

private:
  static constexpr double k_rounding = 1e-6; // steps; a display in step with the simulation must not flicker 0, 2, 0, 2
  double debt_ = 0;                          ///< steps
};

} // namespace tutu::app
