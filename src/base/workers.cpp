#include "src/base/workers.h"

#include "src/base/thread_order.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

// Compiled without the thread sanitizer in its builds: Debian's libtbb is, and half of TBB seen is worse than none.
// ThreadOrder tells the sanitizer what TBB guarantees, so that it watches all that the loops do.

namespace tutu::app {

struct Workers::Arena {
  tbb::task_arena threads;
  ThreadOrder order;

  explicit Arena(int count) : threads(count) {}
};

Workers::Workers(int threads) : threads_(threads) {
  if (threads > 1) arena_ = std::make_unique<Arena>(threads);
}
Workers::~Workers() = default;

void Workers::for_each(std::size_t n, const std::function<void(std::size_t)>& f) {
  if (!arena_) {
    for (std::size_t i = 0; i < n; ++i) f(i);
    return;
  }
  ThreadOrder& order = arena_->order;
  order.hand_out();
  arena_->threads.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, n,
        [&](std::size_t i) {
          order.take();
          f(i);
          order.give_back();
        },
        tbb::simple_partitioner());
  });
  order.collect();
}

} // namespace tutu::app
