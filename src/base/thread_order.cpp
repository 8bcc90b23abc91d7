#include "src/base/thread_order.h"

namespace tutu::app {

void ThreadOrder::hand_out() { handed_out_.fetch_add(1, std::memory_order_release); }
void ThreadOrder::take() { static_cast<void>(handed_out_.load(std::memory_order_acquire)); }
void ThreadOrder::give_back() { given_back_.fetch_add(1, std::memory_order_release); }
void ThreadOrder::collect() { static_cast<void>(given_back_.load(std::memory_order_acquire)); }

} // namespace tutu::app
