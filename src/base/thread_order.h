// What a parallel loop orders: all before it comes before each of its turns, and these come before all after it.
#pragma once

#include <atomic>

namespace tutu::app {

/// Says so in a form that the thread sanitizer understands. Each function is out of line: the sanitizer must see it
/// whoever calls.
class ThreadOrder {
public:
  void hand_out();  ///< the caller, before the loop
  void take();      ///< a turn, first
  void give_back(); ///< a turn, last
  void collect();   ///< the caller, after the loop

private:
  std::atomic<unsigned> handed_out_ = 0, given_back_ = 0;
};

} // namespace tutu::app
