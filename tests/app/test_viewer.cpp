// The window, on a display of the test's own.
#include "src/viewer/viewer.h"
#include "src/viewer/window.h"

#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tutu::app {
namespace {

/// An X server without a screen, and DISPLAY set to it, for as long as it lives.
class VirtualDisplay {
public:
  VirtualDisplay() {
    std::array<int, 2> pipe_ends{};
    if (::pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::array<std::string, 7> words = {"Xvfb", "-displayfd", "1", "-screen", "0", "800x600x24", "-noreset"};
    std::array<char*, 8> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
    const bool started = ::posix_spawnp(&server_, "Xvfb", &actions, nullptr, arguments.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipe_ends[1]);
    if (!started) server_ = 0;
    if (const std::string number = started ? first_line(pipe_ends[0]) : ""; !number.empty()) {
      const char* before = std::getenv("DISPLAY");
      before_ = before ? before : "";
      ::setenv("DISPLAY", (":" + number).c_str(), 1);
      running_ = true;
    }
    ::close(pipe_ends[0]);
  }
  ~VirtualDisplay() {
    if (running_) before_.empty() ? ::unsetenv("DISPLAY") : ::setenv("DISPLAY", before_.c_str(), 1);
    if (server_ == 0) return;
    ::kill(server_, SIGTERM);
    ::waitpid(server_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  bool running() const { return running_; }

private:
  /// Up to the line's end, since the server dies of a pipe closed before; "" when none comes.
  static std::string first_line(int descriptor) {
    std::string line;
    for (char next = 0;;) {
      pollfd readable{.fd = descriptor, .events = POLLIN, .revents = 0};
      if (::poll(&readable, 1, 20000) != 1 || ::read(descriptor, &next, 1) != 1) return "";
      if (next == '\n') return line;
      line += next;
    }
  }

  pid_t server_ = 0;
  bool running_ = false;
  std::string before_;
};

/// A sheet that waves, and counts what it is asked.
class WavingSheet : public Player {
public:
  WavingSheet() {
    for (std::uint32_t y = 0; y + 1 < k_side; ++y)
      for (std::uint32_t x = 0; x + 1 < k_side; ++x) {
        const std::uint32_t a = y * k_side + x;
        triangles_.push_back({a, a + 1, a + k_side});
        triangles_.push_back({a + 1, a + k_side + 1, a + k_side});
      }
    restart();
  }

  void restart() override { seek(0); }
  bool step() override {
    ++steps;
    seek(time_ + frame_seconds());
    return !fails;
  }
  void seek(double time) override {
    time_ = time;
    positions_.clear();
    for (std::uint32_t i = 0; i < k_side * k_side; ++i) {
      const float x = static_cast<float>(i % k_side) / k_side - 0.5f, y = static_cast<float>(i / k_side) / k_side;
      positions_.emplace_back(x, y + 0.5f, 0.05f * std::sin(9 * x + static_cast<float>(6 * time)));
    }
    normals_.assign(positions_.size(), Vec3f::UnitZ());
  }
  double frame_seconds() const override { return 1.0 / 1000; }
  double time() const override { return time_; }
  double duration() const override { return 0.02; }
  std::string title() const override { return "waving sheet"; }
  std::string message() const override { return fails ? "it had to stop" : ""; }
  std::vector<StageTime> stage_times() const override { return {{"cloth", 1.5}, {"contact", 0.5}}; }
  FrameView view(const Layers& layers) override {
    ++views;
    FrameView frame;
    SurfaceView sheet;
    sheet.positions = positions_;
    sheet.normals = normals_;
    sheet.triangles = triangles_;
    sheet.two_sided = true;
    if (layers.cloth) frame.surfaces.push_back(sheet);
    return frame;
  }

  int steps = 0, views = 0;
  bool fails = false;

private:
  static constexpr std::uint32_t k_side = 10;
  std::vector<Vec3f> positions_, normals_;
  std::vector<rig::Triangle> triangles_;
  double time_ = 0;
};

TEST(Viewer, DrawsFramesOnAVirtualDisplayAndCloses_slow) {
  const VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "no Xvfb here";
  ASSERT_TRUE(display_available());
  WavingSheet sheet;
  EXPECT_EQ(run_viewer(sheet, {.width = 640, .height = 480, .max_frames = 20}), 0);
  EXPECT_EQ(sheet.views, 20);
  EXPECT_GT(sheet.steps, 10);
  EXPECT_LE(sheet.steps, 80);
  // It can be opened again, paused: nothing moves then.
  sheet.steps = 0;
  EXPECT_EQ(run_viewer(sheet, {.width = 320, .height = 240, .playing = false, .max_frames = 3}), 0);
  EXPECT_EQ(sheet.steps, 0);
}

TEST(Viewer, StopsPlayingWhenTheSimulationHasToStop_slow) {
  const VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "no Xvfb here";
  WavingSheet sheet;
  sheet.fails = true;
  EXPECT_EQ(run_viewer(sheet, {.width = 320, .height = 240, .max_frames = 10}), 0);
  EXPECT_EQ(sheet.steps, 1);
}

TEST(Viewer, WithoutLoopStaysAtTheEnd_slow) {
  const VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "no Xvfb here";
  WavingSheet sheet;
  EXPECT_EQ(run_viewer(sheet, {.width = 320, .height = 240, .loop = false, .max_frames = 30}), 0);
  EXPECT_NEAR(sheet.time(), sheet.duration(), 1e-9);
  EXPECT_EQ(sheet.steps, 20);
}

TEST(Viewer, WithoutADisplaySaysSo) {
  const char* before = std::getenv("DISPLAY");
  const std::string display = before ? before : "";
  ::setenv("DISPLAY", ":987654", 1);
  EXPECT_FALSE(display_available());
  WavingSheet sheet;
  try {
    run_viewer(sheet, {});
    ADD_FAILURE() << "a window opened on no display";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("display"), std::string::npos) << error.what();
  }
  before ? ::setenv("DISPLAY", display.c_str(), 1) : ::unsetenv("DISPLAY");
}

} // namespace
} // namespace tutu::app
