#include "src/base/interrupt.h"

#include "rig/io/file_io.h"

#include <csignal>
#include <sys/time.h>
#include <unistd.h>

namespace tutu::app {
namespace {

// A handler can reach nothing but a global; lock-free atomics are safe there, and in worker threads too.
std::atomic<bool> g_interrupted = false, g_seen = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void set_action(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

void set_timer(double seconds) {
  itimerval timer{};
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * seconds);
  setitimer(ITIMER_REAL, &timer, nullptr);
}

extern "C" void end_at_once(int) {
  if (g_seen) return; // the timer was set off just before somebody looked
  abandon_pending_files();
  constexpr char k_words[] = "\ntutu: interrupted in the middle of a long step; files are as they were before it\n";
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, k_words, sizeof k_words - 1);
  ::_exit(1);
}

extern "C" void remember_interrupt(int) { // calls nothing but what is safe in a handler
  g_interrupted = true;
  set_action(SIGINT, SIG_DFL, 0);
  set_action(SIGTERM, SIG_DFL, 0);
  set_action(SIGALRM, &end_at_once, 0);
  set_timer(k_interrupt_seconds);
}

} // namespace

void catch_interrupt() {
  g_interrupted = g_seen = false;
  set_action(SIGINT, &remember_interrupt, SA_RESTART);
  set_action(SIGTERM, &remember_interrupt, SA_RESTART);
}

bool interrupted() {
  if (!g_interrupted) return false;
  if (!g_seen.exchange(true)) set_timer(0.0);
  return true;
}

const std::atomic<bool>& interrupt_flag() { return g_interrupted; }

} // namespace tutu::app
