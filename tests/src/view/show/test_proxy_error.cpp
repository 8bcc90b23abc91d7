// The error overlay: colours, the labelled bar, and both in a picture.
#include "src/measure/worst_frame.h"
#include "src/scene/load.h"
#include "src/view/render/error_colours.h"
#include "src/view/render/offscreen.h"
#include "src/view/render/png.h"
#include "src/view/show/proxy_error_colours.h"
#include "src/view/show/scene_view.h"
#include "tests/support/capsule_character.h"
#include "tests/support/opengl_here.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>
#include <set>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

const ErrorScale k_scale = ErrorScale::of(0.01);

double lightness(const std::array<float, 3>& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

TEST(ErrorColours, AreWhiteWithinTheToleranceAndDarkenOnBothSides) {
  const auto white = error_srgb(k_scale, 0.0);
  EXPECT_EQ(error_srgb(k_scale, 0.0099), white);
  EXPECT_EQ(error_srgb(k_scale, -0.0099), white);
  for (const double side : {1.0, -1.0}) {
    double last = lightness(white);
    for (double error = 0.0101; error < 0.04; error += 0.001) {
      const auto colour = error_srgb(k_scale, side * error);
      EXPECT_LT(lightness(colour), last) << side * error;
      last = lightness(colour);
      if (side > 0) {
        EXPECT_GT(colour[0], colour[2]);
      } // orange: the skin sticks out
      else {
        EXPECT_GT(colour[2], colour[0]);
      } // blue
    }
    EXPECT_EQ(error_srgb(k_scale, side), error_srgb(k_scale, 0.04 * side)); // beyond: the last
  }
}

TEST(ErrorColours, TicksAreInMillimetres) {
  const auto ticks = error_ticks(k_scale);
  ASSERT_EQ(ticks.size(), 5u);
  EXPECT_EQ(ticks.front().second, "-40");
  EXPECT_EQ(ticks[2].second, "0");
  EXPECT_EQ(ticks[3].second, "+10");
  EXPECT_EQ(ticks.back().second, "+40 mm");
}

/// How many pixels of the row differ from each other, at least by name of their colour.
std::size_t colours_in_row(const Image& image, int y) {
  std::set<std::array<std::uint8_t, 3>> seen;
  for (int x = 0; x < image.width; ++x) seen.insert({image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]});
  return seen.size();
}

TEST(ErrorColours, TheBarIsDrawnWithItsWords) {
  Image image{480, 640, std::vector<std::uint8_t>(3 * 480 * 640, 100)};
  draw_error_bar(k_scale, image);
  std::size_t most = 0;
  for (int y = 560; y < 640; ++y) most = std::max(most, colours_in_row(image, y));
  EXPECT_GT(most, 100u); // the bar's own row
  int ink = 0;           // of the words
  for (int y = 560; y < 640; ++y)
    for (int x = 0; x < 480; ++x) ink += image.at(x, y)[0] < 60 && image.at(x, y)[2] < 80;
  EXPECT_GT(ink, 400);
  for (int y = 0; y < 560; ++y) ASSERT_EQ(colours_in_row(image, y), 1u); // the rest of the picture is left alone

  Image small{120, 100, std::vector<std::uint8_t>(3 * 120 * 100, 100)};
  draw_error_bar(k_scale, small); // no room for words: nothing
  EXPECT_EQ(colours_in_row(small, 90), 1u);
}

class ProxyError : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = scratch_folder();
    CapsuleBody body;
    const proxies::Capsule trunk{{0, 0.3, 0}, {0, 0.7, 0}, 0.12};
    body.add(trunk, 48, 12, 8);
    write_capsule_character(folder_ / "body.dae", body, {0, 0.5, 0});
    // 30 mm aside: on one side the skin sticks out, on the other the proxy. The skin's arm end drifts off in the
    // middle.
    const Vec3 aside(0.03, 0, 0);
    write_file(folder_ / "proxies.json", proxies_json({{trunk.a + aside, trunk.b + aside, trunk.radius}}));
    write_file(folder_ / "still.json", R"({"keys": [{"time": 0, "joints": {}}]})");
    write_file(folder_ / "scene.json",
               R"({"character": "body.dae", "motion": "still.json", "proxies": "proxies.json"})");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  LoadedScene scene() const { return load_scene(read_scene(folder_ / "scene.json")); }

  std::filesystem::path folder_;
};

TEST_F(ProxyError, VerticesAreColouredByTheirDistanceFromTheUnion) {
  const std::vector<Vec3f> points = {{0, 0, 0}, {0.3f, 0, 0}, {0.1f, 0, 0}};
  const std::vector<proxies::Capsule> ball = {{Vec3::Zero(), Vec3::Zero(), 0.1}};
  ProxyErrorColours colours;
  const auto coloured = colours.update(points, ball, k_scale);
  EXPECT_EQ(coloured[0], error_colour(k_scale, -0.1));
  EXPECT_EQ(coloured[1], error_colour(k_scale, 0.2));
  EXPECT_EQ(coloured[2], error_colour(k_scale, 0.0));
}

TEST_F(ProxyError, ThePictureShowsBothSidesAndTheBar_slow) {
  const LoadedScene loaded = scene();
  Session session(loaded);
  session.start({});
  session.skin_body();
  SceneView view(loaded);
  Layers layers;
  layers.proxy_error = true;
  const FrameView frame = view.frame(session, layers);
  ASSERT_TRUE(frame.error_scale);
  ASSERT_FALSE(frame.surfaces.front().colours.empty());
  if (const std::string missing = test::missing_opengl(); !missing.empty()) GTEST_SKIP() << missing;
  Offscreen offscreen({480, 480, 1});
  const auto points = session.body_positions();
  const Image image = offscreen.draw(frame, frame_camera(points, 0.0f, 0.1f, offscreen.aspect()));
  int orange = 0, blue = 0, orange_left = 0;
  for (int y = 0; y < 400; ++y) // above the bar
    for (int x = 0; x < 480; ++x) {
      const std::uint8_t* p = image.at(x, y);
      const bool is_orange = p[0] > p[2] + 60;
      orange += is_orange;
      orange_left += is_orange && x < 240;
      blue += p[2] > p[0] + 60;
    }
  EXPECT_GT(orange, 500);
  EXPECT_GT(blue, 500);
  EXPECT_EQ(orange, orange_left); // the proxy moved to +x, the picture's right
  std::size_t most = 0;
  for (int y = 420; y < 480; ++y) most = std::max(most, colours_in_row(image, y));
  EXPECT_GT(most, 100u);

  layers.proxy_error = false;
  EXPECT_FALSE(view.frame(session, layers).error_scale);
}

TEST_F(ProxyError, TheWorstFrameIsWhereTheSkinSticksOutTheMost) {
  // Its sphere stays with the arm joint, which swings away and back: worst in the middle.
  write_file(
      folder_ / "proxies.json",
      R"({"proxies": [{"capsule": {"joint": "LeftArm", "a": [-0.3, 0.3, 0], "b": [-0.3, 0.7, 0], "radius": 0.12}}]})");
  write_file(folder_ / "still.json", R"({"keys": [{"time": 0, "joints": {}},
    {"time": 0.2, "joints": {"LeftArm": {"translation": [0.5, 0, 0]}}}, {"time": 0.5, "joints": {}}]})");
  EXPECT_EQ(worst_frame(scene(), [](int, int) { return true; }), 12);
  EXPECT_EQ(worst_frame(scene(), [](int, int) { return false; }), std::nullopt);
}

} // namespace
