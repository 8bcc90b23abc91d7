#include "src/base/interrupt.h"

#include <atomic>
#include <csignal>

namespace tutu::app {
namespace {

// A handler can reach nothing but a global; lock-free atomics are safe there, and in worker threads too.
std::atomic<bool> g_interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void set_action(void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

extern "C" void remember_interrupt(int) {
  g_interrupted = true;
  set_action(SIG_DFL, 0); // sigaction is safe to call in a handler
}

} // namespace

void catch_interrupt() {
  g_interrupted = false;
  set_action(&remember_interrupt, SA_RESTART);
}

bool interrupted() { return g_interrupted; }
const std::atomic<bool>& interrupt_flag() { return g_interrupted; }

} // namespace tutu::app
