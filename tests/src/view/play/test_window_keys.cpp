// The program in a real window, driven by keys and the mouse as a person would: Xvfb and xdotool.
#include "rig/io/file_io.h"
#include "src/run/drape.h"
#include "src/scene/load.h"
#include "src/view/render/camera.h"
#include "src/view/show/scene_view.h"
#include "src/view/show/why.h"
#include "src/view/window/orbit.h"
#include "tests/support/child_program.h"
#include "tests/support/first_camera.h"
#include "tests/support/paths.h"
#include "tests/support/read_png.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"
#include "tests/support/virtual_display.h"

#include <chrono>
#include <functional>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace tutu::app {
namespace {

constexpr int k_width = 640, k_height = 480;

/// Waits for a condition, as long as the slowest machine may take.
bool wait_until(const std::function<bool()>& condition) {
  for (int k = 0; k < 1200; ++k) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

/// The program in its window, until it ends by itself or with this.
class RunningProgram {
public:
  explicit RunningProgram(const std::vector<std::string>& arguments) {
    std::vector<std::string> words = {TUTU_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    if (::posix_spawn(&pid_, TUTU_PROGRAM, nullptr, nullptr, pointers.data(), environ) != 0) pid_ = 0;
  }
  ~RunningProgram() {
    if (pid_ == 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Its exit status, or -1 when it does not end.
  int status() {
    int status = -1;
    if (!wait_until([&] { return ::waitpid(pid_, &status, WNOHANG) == pid_; })) return -1;
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

private:
  pid_t pid_ = 0;
};

class WindowKeys : public ::testing::Test {
protected:
  void SetUp() override {
    if (!display_.running()) GTEST_SKIP() << "no Xvfb here";
    if (!test::xdotool_available()) GTEST_SKIP() << "no xdotool here";
    folder_ = test::scratch_folder();
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    file_ = test::write_small_scene(folder_);
  }
  void TearDown() override {
    ::unsetenv("XDG_STATE_HOME");
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  static void xdotool(const std::string& words) {
    ASSERT_EQ(std::system(("xdotool " + words + " > /dev/null 2>&1").c_str()), 0) << words;
  }
  /// A picture of the window as it is, taken by its own key, when all keys before it have done their work.
  std::optional<Image> screenshot(const std::string& name) const {
    xdotool("key F12");
    const auto png = folder_ / "shots" / (name + ".png");
    if (!wait_until([&] { return exists(png); })) return std::nullopt;
    return test::read_png(png);
  }

  VirtualDisplay display_;
  std::filesystem::path folder_;
  std::string file_;
};

/// As the program starts it.
GarmentPositions settled(const LoadedScene& scene) {
  return drape(scene, 4.0, [](int, int) { return true; }).positions;
}

TEST_F(WindowKeys, TheWindowComesToTheSameBitsAsNoWindow_slow) {
  const auto in_window = folder_ / "window.json", without = folder_ / "headless.json";
  for (const char* frames : {"1", "25"}) {
    test::Outcome outcome =
        test::run_program({"play", file_, "--window", "--frames", frames, "--size", "320x240", "--json", in_window});
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    outcome = test::run_program({"play", file_, "--headless", "--no-pictures", "--frames", frames, "--json", without});
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const auto window = nlohmann::json::parse(read_file(in_window)),
               headless = nlohmann::json::parse(read_file(without));
    EXPECT_EQ(window["frame"], std::atoi(frames));
    EXPECT_EQ(window["state_hash"], headless["state_hash"]);
  }
}

TEST_F(WindowKeys, LayersStepsAndAClick_slow) {
  const auto json_file = folder_ / "end.json";
  RunningProgram program(
      {"play", file_, "--window", "--paused", "--size", "640x480", "-o", folder_ / "shots", "--json", json_file});
  ASSERT_TRUE(wait_until([] { return std::system("xdotool search --name 'tutu - small' > /dev/null 2>&1") == 0; }));
  xdotool("mousemove 320 240");
  // Keys of a window that is not drawn yet are lost: this one is asked for until it works.
  ASSERT_TRUE(wait_until([&] {
    xdotool("key F12");
    return exists(folder_ / "shots" / "small-0000.png");
  }));
  xdotool("key Tab"); // no panels in the pictures
  for (int k = 0; k < 12; ++k) xdotool("key period");
  const auto plain = screenshot("small-0012");
  ASSERT_TRUE(plain);
  ASSERT_EQ(plain->width, k_width);
  int shot = 1;
  for (const LayerInfo& layer : k_layers) {
    if (std::string(layer.name) == "sweeps") continue; // this capsule only turns about itself
    const std::string key = std::string("key ") + layer.key;
    xdotool(key);
    const auto changed = screenshot("small-0012-" + std::to_string(++shot));
    xdotool(key);
    ASSERT_TRUE(changed) << layer.name;
    EXPECT_GT(test::share_changed(*plain, *changed), 0.0005) << layer.name;
  }
  const auto again = screenshot("small-0012-" + std::to_string(++shot));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->pixels, plain->pixels); // all are off again
  // Back to the start and on again, by what was recorded; then some single frames back.
  xdotool("key Left Left"); // ten each: to the first frame
  for (int k = 0; k < 10; ++k) xdotool("key period");
  xdotool("key comma");

  // The particle that is nearest to the eye, where the program's own camera shows it.
  const LoadedScene scene = load_scene(read_scene(file_));
  Session session(scene);
  session.start(settled(scene));

  const Camera camera = test::first_camera(scene, static_cast<float>(k_width) / k_height);
  FrameState before, now;
  for (int f = 1; f <= 9; ++f) {
    session.advance();
    std::swap(before, now);
    capture(session, now);
  }
  const std::vector<Vec3>& positions = now.garments[0].positions;
  const auto away = [&](const Vec3& p) { return (p.cast<float>() - camera.eye).norm(); };
  const auto nearest = std::min_element(positions.begin(), positions.end(),
                                        [&](const Vec3& p, const Vec3& q) { return away(p) < away(q); });
  const int particle = static_cast<int>(nearest - positions.begin());
  const auto pixel = project(camera, k_width, k_height, nearest->cast<float>());
  ASSERT_TRUE(pixel);
  xdotool("mousemove " + std::to_string(static_cast<int>(pixel->x())) + " " +
          std::to_string(static_cast<int>(pixel->y())));
  ASSERT_TRUE(screenshot("small-0009")); // the pointer is there
  xdotool("click 1");
  ASSERT_TRUE(screenshot("small-0009-2"));
  xdotool("key Escape");
  EXPECT_EQ(program.status(), 0);

  const auto end = nlohmann::json::parse(read_file(json_file));
  EXPECT_EQ(end["frame"], 9);
  EXPECT_EQ(end["state_hash"], fmt::format("{:016x}", session.state_hash()));
  EXPECT_EQ(end["layers"], (std::vector<std::string>{"body", "cloth", "ground"}));
  EXPECT_FALSE(end["playing"]);
  EXPECT_EQ(end["recorded"]["first"], 0);
  ASSERT_FALSE(end["why"].is_null()) << "the click found nothing";
  Why why = explain(scene, 0, particle, now, &before);
  EXPECT_EQ(end["why"], json_of(why)); // nothing went wrong
}

} // namespace
} // namespace tutu::app
