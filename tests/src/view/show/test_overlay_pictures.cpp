// Each overlay in a picture: it changes a share of the pixels, and looks as its reference does. To make the references
// anew, after having looked at them: TUTU_WRITE_GOLDEN=1 build/release/tests/test_app
// --gtest_filter='OverlayPictures.*'
#include "src/scene/load.h"
#include "src/view/render/offscreen.h"
#include "src/view/render/png.h"
#include "src/view/show/scene_view.h"
#include "tests/support/opengl_here.h"
#include "tests/support/paths.h"
#include "tests/support/read_png.h"
#include "tests/support/small_scene.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <optional>

namespace tutu::app {
namespace {

constexpr int k_width = 160, k_height = 120;
constexpr double k_off_golden = 0.01; // share of pixels that may differ from the reference: another driver's edges

struct Expected {
  const char* layer;
  double least, most; // share of the pixels that it changes
};
constexpr Expected k_expected[] = {
    {"wireframe", 0.02, 0.5},    {"particles", 0.005, 0.2}, {"skeleton", 0.0, 0.2},   {"joints", 0.001, 0.2},
    {"proxies", 0.05, 0.5},      {"boxes", 0.01, 0.3},      {"sweeps", 0.02, 0.5},    {"strain", 0.02, 0.5},
    {"attachments", 0.002, 0.1}, {"tiles", 0.01, 0.4},      {"contacts", 0.005, 0.3}, {"proxy-error", 0.01, 0.5},
    {"penetration", 0.02, 0.5},
};

TEST(OverlayPictures, EachChangesItsShareAndLooksAsItsReference_slow) {
  if (const std::string missing = test::missing_opengl(); !missing.empty()) GTEST_SKIP() << missing;
  Offscreen offscreen({k_width, k_height, 1});
  const bool write = std::getenv("TUTU_WRITE_GOLDEN") != nullptr;
  const auto references = test::source_file("tests/fixtures/overlays");
  const auto folder = test::scratch_folder();
  const LoadedScene scene = load_scene(read_scene(test::write_small_scene(folder)));
  Session session(scene);
  session.start({scene.garments[0].rest_positions});
  for (int f = 0; f < 12; ++f) session.advance();
  session.skin_body();
  FrameState state;
  capture(session, state);
  for (Vec3* end : {&state.colliders_start[0].a, &state.colliders_start[0].b}) end->x() += 0.05; // it went somewhere
  const SkinView skin{session.body_positions(), session.body_normals()};
  SceneView view(scene);
  const Camera camera =
      frame_camera(Vec3f(-0.25f, 0.1f, -0.25f), Vec3f(0.25f, 0.9f, 0.25f), 0.6f, 0.25f, offscreen.aspect());
  const Image plain = offscreen.draw(view.frame(state, skin, {}), camera);
  for (const Expected& expected : k_expected) {
    SCOPED_TRACE(expected.layer);
    Layers layers;
    for (const LayerInfo& layer : k_layers)
      if (std::string(layer.name) == expected.layer) layers.*layer.member = true;
    const Image image = offscreen.draw(view.frame(state, skin, layers), camera);
    const double share = test::share_changed(plain, image);
    EXPECT_GE(share, expected.least);
    EXPECT_LE(share, expected.most);
    const auto file = references / (std::string(expected.layer) + ".png");
    if (write) write_png(file, image);
    const auto golden = test::read_png(file);
    ASSERT_TRUE(golden) << "no reference " << file;
    ASSERT_EQ(golden->pixels.size(), image.pixels.size());
    EXPECT_LE(test::share_changed(*golden, image), k_off_golden);
  }
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace tutu::app
