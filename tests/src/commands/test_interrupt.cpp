// Ctrl-C: whole files, and an end within a second, also where nobody looks.
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "tests/support/child_program.h"
#include "tests/support/paths.h"
#include "tests/support/small_scene.h"

#include <atomic>
#include <chrono>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

namespace fs = std::filesystem;

TEST(Interrupt, WhereNobodyLooksTheProgramEndsByItselfAndTakesItsPartsAlong) {
  const fs::path folder = scratch_folder();
  const pid_t child = ::fork();
  if (child == 0) {
    catch_interrupt();
    const auto* pending = new PendingFile(folder / "film.mp4");
    (void)pending;
    ::raise(SIGINT);
    for (;;) std::atomic_signal_fence(std::memory_order_seq_cst); // a frame of minutes
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

TEST(Interrupt, WhoLooksHasAllTheTimeThereIs) {
  const pid_t child = ::fork();
  if (child == 0) {
    catch_interrupt();
    ::raise(SIGINT);
    if (!interrupted()) ::_exit(2);
    std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(1500.0 * k_interrupt_seconds)));
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

} // namespace
