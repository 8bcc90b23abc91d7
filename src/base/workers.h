// Threads for loops whose turns do not depend on each other: oneTBB behind a face that shows no TBB.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace tutu::app {

class Workers {
public:
  /// threads >= 1; of one there is only the caller's.
  explicit Workers(int threads);
  ~Workers();

  int count() const { return threads_; }

  /// Calls f(0) .. f(n - 1), each once, in any order and side by side; returns when all are done. What f throws comes
  /// out, and turns that had not begun are left out then. One call at a time.
  void for_each(std::size_t n, const std::function<void(std::size_t)>& f);

private:
  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_; ///< none for one thread
};

} // namespace tutu::app
