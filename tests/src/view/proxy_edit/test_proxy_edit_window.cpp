// Proxy editing as a user meets it: the window on a display of the test's own, with real pointer and keys.
#include "proxies/proxy_file.h"
#include "rig/io/file_io.h"
#include "src/run/posed_body.h"
#include "src/scene/load.h"
#include "src/view/proxy_edit/proxy_document.h"
#include "src/view/proxy_edit/proxy_handles.h"
#include "src/view/show/scene_view.h"
#include "src/view/window/orbit.h"
#include "tests/support/child_program.h"
#include "tests/support/first_camera.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"
#include "tests/support/virtual_display.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace tutu::app {
namespace {

using test::xdotool;

constexpr int k_width = 640, k_height = 480;

/// Waits for a condition, as long as the slowest machine may take.
bool wait_until(const std::function<bool()>& condition) {
  for (int k = 0; k < 1200; ++k) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

class ProxyEditWindow : public ::testing::Test {
protected:
  void SetUp() override {
    if (!display_.running()) GTEST_SKIP() << "no Xvfb here";
    if (!test::xdotool_available()) GTEST_SKIP() << "no xdotool here";
    folder_ = test::scratch_folder();
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    file_ = test::write_small_scene(folder_);
    proxies_ = folder_ / "proxies.json";
  }
  void TearDown() override {
    program_.reset();
    ::unsetenv("XDG_STATE_HOME");
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  void start() {
    program_.emplace(std::vector<std::string>{"play", file_, "--window", "--paused", "--size", "640x480", "-o",
                                              folder_ / "shots", "--json", folder_ / "end.json"},
                     folder_ / "output.txt");
    ASSERT_TRUE(wait_until([] { return xdotool("search --name 'tutu - small'"); }));
    ASSERT_TRUE(xdotool("search --sync --onlyvisible --name 'tutu - small' windowmove 0 0 windowfocus --sync"));
    ASSERT_TRUE(xdotool("mousemove 320 240"));
    // Keys of a window that is not drawn yet are lost: this one is asked for until it works.
    ASSERT_TRUE(wait_until([&] {
      xdotool("key F12");
      return exists(folder_ / "shots" / "small-0000.png");
    }));
  }
  /// Waits until the file is another one.
  bool saved(const std::string& before) const {
    return wait_until([&] { return read_file(proxies_) != before; });
  }

  /// Waits for another picture by its key, hence until all before it was done.
  bool drawn() const {
    const auto pictures = [&] {
      const std::filesystem::directory_iterator all(folder_ / "shots");
      return std::count_if(begin(all), end(all), [](const auto& file) { return file.path().extension() == ".png"; });
    };
    const auto before = pictures();
    return xdotool("key F12") && wait_until([&] { return pictures() > before; });
  }

  VirtualDisplay display_;
  std::filesystem::path folder_, proxies_;
  std::string file_;
  std::optional<test::ChildProgram> program_;
};

TEST_F(ProxyEditWindow, AnEndIsDraggedSavedUndoneAndPlayed_slow) {
  const LoadedScene scene = load_scene(read_scene(file_));
  const Camera camera = test::first_camera(scene, static_cast<float>(k_width) / k_height);
  const PosedBody body(scene); // at the start, where the window stands
  const proxies::Proxy before = scene.proxies.front();
  const proxies::Capsule shape = posed(before, body.world_from_joint());
  const auto pixel_of = [&](const Vec3& p) {
    const auto seen = project(camera, k_width, k_height, p.cast<float>());
    return seen ? std::pair{static_cast<int>(seen->x()), static_cast<int>(seen->y())} : std::pair{0, 0};
  };
  start();
  if (HasFatalFailure()) return;
  const std::string original = read_file(proxies_);

  // A quarter of the way along: on the proxy, and away from its handles once it is selected.
  const auto [on_x, on_y] = pixel_of(shape.a + 0.25 * (shape.b - shape.a));
  const auto [x, y] = pixel_of(shape.a);
  const int to_x = x + 43, to_y = y - 29;
  ASSERT_TRUE(xdotool("key Tab key m")); // no panels in the way
  ASSERT_TRUE(xdotool(fmt::format("mousemove {} {} click 1", on_x, on_y)));
  ASSERT_TRUE(xdotool(fmt::format("mousemove {} {} mousedown 1", x, y)));
  for (const int step : {1, 2, 3})
    ASSERT_TRUE(xdotool(fmt::format("mousemove {} {}", x + (to_x - x) * step / 3, y + (to_y - y) * step / 3)));
  ASSERT_TRUE(xdotool("mouseup 1"));
  ASSERT_TRUE(xdotool("key ctrl+s"));
  ASSERT_TRUE(saved(original));

  // The closed form: the end follows the line of sight in the plane through it that faces the camera.
  const Vec3 eye = camera.eye.cast<double>(), forward = (camera.target.cast<double>() - eye).normalized();
  const Vec3 right = forward.cross(Vec3::UnitY()).normalized(), up = right.cross(forward);
  const double per_pixel = 2.0 * std::tan(0.5 * static_cast<double>(camera.vertical_fov)) / k_height;
  const auto in_plane = [&](int px, int py) -> Vec3 {
    const double aside = (px + 0.5 - 0.5 * k_width) * per_pixel, above = (0.5 * k_height - py - 0.5) * per_pixel;
    return (shape.a - eye).dot(forward) * (forward + aside * right + above * up);
  };
  const Vec3 world = shape.a + in_plane(to_x, to_y) - in_plane(x, y);
  const Transform joint = body.world_from_joint()[before.a.joints[0]];
  const Vec3 expected = joint.rotation.conjugate() * (world - joint.translation);
  const std::string edited = read_file(proxies_);
  const auto read = proxies::read_proxies(proxies_, scene.character.skeleton);
  ASSERT_EQ(read.size(), 1u);
  const double off = (read[0].a.points[0] - expected).norm();
  EXPECT_LT(off, 1e-6);
  std::printf("drag: off the closed form by %.3g m, of %.3g m\n", off, (world - shape.a).norm());
  EXPECT_GT((world - shape.a).norm(), 0.03);
  EXPECT_EQ(read[0].b.points[0], before.b.points[0]);
  EXPECT_EQ(read[0].radius, before.radius);

  ASSERT_TRUE(xdotool("key ctrl+z key ctrl+s"));
  ASSERT_TRUE(saved(edited));
  EXPECT_TRUE(same_proxies(proxies::read_proxies(proxies_, scene.character.skeleton), scene.proxies));
  const std::string undone = read_file(proxies_);
  ASSERT_TRUE(xdotool("key ctrl+y key ctrl+s"));
  ASSERT_TRUE(saved(undone));
  EXPECT_EQ(read_file(proxies_), edited);

  // Playing on is playing the file.
  ASSERT_TRUE(xdotool("key m key Escape"));
  EXPECT_EQ(program_->end(0), 0);
  const auto end = nlohmann::json::parse(read_file(folder_ / "end.json"));
  EXPECT_EQ(end["proxy_edit"]["selected"], "p0");
  EXPECT_EQ(end["proxy_edit"]["unsaved"], false);
  EXPECT_EQ(end["proxy_edit"]["undo_depth"], 1);
  const auto once = [&] {
    const auto json = folder_ / "again.json";
    test::ChildProgram again({"play", file_, "--window", "--paused", "--size", "640x480", "--json", json},
                             folder_ / "again.txt");
    EXPECT_TRUE(wait_until([&] { // keys of a window that is not drawn yet are lost
      xdotool("search --onlyvisible --name 'tutu - small' windowfocus --sync key Escape");
      return exists(json) && std::filesystem::file_size(json) > 0;
    }));
    EXPECT_EQ(again.end(0), 0);
    return nlohmann::json::parse(read_file(json));
  };
  EXPECT_EQ(end["state_hash"], once()["state_hash"]);
}

TEST_F(ProxyEditWindow, ClosingWithUnsavedEditsAsks_slow) {
  start();
  if (HasFatalFailure()) return;
  const std::string original = read_file(proxies_);
  const auto press = [&](const char* key) {
    ASSERT_TRUE(xdotool(std::string("key ") + key));
    ASSERT_TRUE(drawn());
  };
  press("m");
  press("ctrl+b"); // a sphere on the first joint
  press("Escape"); // asks
  press("Escape"); // stays
  press("ctrl+k"); // and a capsule, which a window that had closed could not
  press("Escape");
  ASSERT_TRUE(xdotool("key Return")); // saves and leaves
  EXPECT_EQ(program_->end(0), 0);
  EXPECT_NE(read_file(proxies_), original);
  const LoadedScene scene = load_scene(read_scene(file_));
  ASSERT_EQ(scene.proxies.size(), 3u);
  EXPECT_EQ(scene.proxies[1].kind, proxies::ProxyKind::sphere);
  EXPECT_EQ(scene.proxies[2].kind, proxies::ProxyKind::capsule);
}

} // namespace
} // namespace tutu::app
