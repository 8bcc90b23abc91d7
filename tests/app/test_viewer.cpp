// The window, on a display of the test's own.
#include "src/viewer/viewer.h"
#include "src/viewer/window.h"
#include "tests/support/virtual_display.h"

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <string>

namespace tutu::app {
namespace {

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
