// The window, on a display of the test's own.
#include "rig/io/file_io.h"
#include "src/view/play/viewer.h"
#include "src/view/play/viewer_commands.h"
#include "src/view/window/recent_files.h"
#include "src/view/window/window.h"
#include "tests/support/paths.h"
#include "tests/support/virtual_display.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <set>
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
    rewind();
  }

  void rewind() override { seek(0); }
  void go(int frames) override {
    steps += frames;
    seek(time_ + frames * frame_seconds());
  }
  void seek(double time) override {
    time_ = std::clamp(time, 0.0, duration());
    positions_.clear();
    for (std::uint32_t i = 0; i < k_side * k_side; ++i) {
      const float x = static_cast<float>(i % k_side) / k_side - 0.5f, y = static_cast<float>(i / k_side) / k_side;
      positions_.emplace_back(x, y + 0.5f, 0.05f * std::sin(9 * x + static_cast<float>(6 * time)));
    }
    normals_.assign(positions_.size(), Vec3f::UnitZ());
  }
  bool at_end() const override { return (fails && steps > 0) || time_ >= duration() - 0.5 * frame_seconds(); }
  double frame_seconds() const override { return 1.0 / 1000; }
  double time() const override { return time_; }
  double duration() const override { return 0.02; }
  std::string title() const override { return "waving sheet"; }
  std::string message() const override { return fails ? "it had to stop" : ""; }
  std::vector<StageTime> stage_times() const override { return {{"cloth", 1.5}, {"contact", 0.5}}; }
  std::vector<FrameView> views(const Layers& layers) override {
    ++drawn;
    FrameView frame;
    SurfaceView sheet;
    sheet.positions = positions_;
    sheet.normals = normals_;
    sheet.triangles = triangles_;
    sheet.two_sided = true;
    if (layers.cloth) frame.surfaces.push_back(sheet);
    return {frame};
  }

  int steps = 0, drawn = 0;
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
  const ViewerEnd end = run_viewer(sheet, {.width = 640, .height = 480, .max_frames = 20});
  EXPECT_TRUE(end.playing);
  EXPECT_FALSE(end.open);
  EXPECT_EQ(sheet.drawn, 20);
  EXPECT_GT(sheet.steps, 10);
  // It can be opened again, paused: nothing moves then.
  sheet.steps = 0;
  EXPECT_FALSE(run_viewer(sheet, {.width = 320, .height = 240, .playing = false, .max_frames = 3}).playing);
  EXPECT_EQ(sheet.steps, 0);
}

TEST(Viewer, StopsPlayingWhenTheSimulationHasToStop_slow) {
  const VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "no Xvfb here";
  WavingSheet sheet;
  sheet.fails = true;
  EXPECT_FALSE(run_viewer(sheet, {.width = 320, .height = 240, .max_frames = 10}).playing);
  EXPECT_GT(sheet.steps, 0);
  EXPECT_GT(sheet.time(), 0.0); // not back at the start, as a loop would be
}

TEST(Viewer, WithoutLoopStaysAtTheEnd_slow) {
  const VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "no Xvfb here";
  WavingSheet sheet;
  EXPECT_FALSE(run_viewer(sheet, {.width = 320, .height = 240, .loop = false, .max_frames = 30}).playing);
  EXPECT_NEAR(sheet.time(), sheet.duration(), 1e-9);
}

TEST(Viewer, ClosesWithTheLastFrameWhenAsked_slow) {
  const VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "no Xvfb here";
  WavingSheet sheet;
  run_viewer(sheet, {.width = 320, .height = 240, .loop = false, .close_at_end = true, .max_frames = 1000});
  EXPECT_NEAR(sheet.time(), sheet.duration(), 1e-9);
  EXPECT_LT(sheet.drawn, 1000);
}

TEST(ViewerCommands, EveryKeyDoesOneThing) {
  std::set<char> characters;
  std::set<int> keys;
  std::set<std::string> shortcuts;
  std::size_t with_character = 0, with_key = 0;
  for (const ViewerCommand& command : viewer_commands()) {
    EXPECT_NE(command.character != 0, command.key != 0) << command.label;
    with_character += command.character != 0;
    with_key += command.key != 0;
    characters.insert(command.character);
    keys.insert(command.key);
    shortcuts.insert(command.shortcut);
  }
  for (const LayerInfo& layer : k_layers) EXPECT_FALSE(characters.count(layer.key)) << layer.name;
  EXPECT_EQ(characters.size(), with_character + 1); // 0 for those without
  EXPECT_EQ(keys.size(), with_key + 1);
  EXPECT_EQ(shortcuts.size(), viewer_commands().size());
  ViewerState state;
  apply_character('.', state);
  apply_character('.', state);
  apply_character(',', state);
  EXPECT_EQ(state.steps, 1); // none is lost between two pictures
  apply_character('W', state);
  EXPECT_TRUE(state.layers.wireframe);
  apply_character('w', state);
  EXPECT_FALSE(state.layers.wireframe);
  apply_character(0x1F600, state); // nobody's
}

TEST(RecentFiles, TheNewestComesFirstAndWhatIsGoneDoesNot) {
  const auto folder = test::scratch_folder();
  const char* before = std::getenv("XDG_STATE_HOME");
  const std::string old = before ? before : "";
  ::setenv("XDG_STATE_HOME", folder.c_str(), 1);
  EXPECT_TRUE(recent_files().empty());
  for (int k = 0; k < 10; ++k) {
    const auto file = folder / std::to_string(k);
    write_file(file, "");
    remember_file(file);
  }
  remember_file(folder / "5");
  std::filesystem::remove(folder / "9");
  const std::vector<std::string> files = recent_files();
  ASSERT_EQ(files.size(), k_recent_files - 1);
  EXPECT_EQ(files[0], (folder / "5").string());
  EXPECT_EQ(files[1], (folder / "8").string());
  before ? ::setenv("XDG_STATE_HOME", old.c_str(), 1) : ::unsetenv("XDG_STATE_HOME");
  std::filesystem::remove_all(folder);
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
