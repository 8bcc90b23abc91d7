// Pictures without a window. All need OpenGL, which leaks under the address sanitizer: hence "_slow".
#include "src/view/render/camera.h"
#include "src/view/render/offscreen.h"
#include "src/view/render/png.h"
#include "tests/support/opengl_here.h"
#include "tests/support/paths.h"

#include "rig/io/file_io.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <random>
#include <stb/stb_image.h>

namespace tutu::app {
namespace {

constexpr int k_width = 320, k_height = 240;

struct Surface {
  std::vector<Vec3f> positions, normals;
  std::vector<rig::Triangle> triangles;

  SurfaceView view(Colour colour) const {
    SurfaceView v;
    v.positions = positions;
    v.normals = normals;
    v.triangles = triangles;
    v.colour = colour;
    return v;
  }
};

Surface sphere(const Vec3f& centre, float radius) {
  constexpr std::uint32_t k_rows = 16, k_columns = 32;
  Surface s;
  for (std::uint32_t r = 0; r <= k_rows; ++r)
    for (std::uint32_t c = 0; c < k_columns; ++c) {
      const float latitude = 3.14159265f * (static_cast<float>(r) / k_rows - 0.5f);
      const float longitude = 2 * 3.14159265f * static_cast<float>(c) / k_columns;
      const Vec3f n(std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                    std::cos(latitude) * std::sin(longitude));
      s.positions.push_back(centre + radius * n);
      s.normals.push_back(n);
    }
  for (std::uint32_t r = 0; r < k_rows; ++r)
    for (std::uint32_t c = 0; c < k_columns; ++c) {
      const std::uint32_t a = r * k_columns + c, b = r * k_columns + (c + 1) % k_columns;
      s.triangles.push_back({a, a + k_columns, b});
      s.triangles.push_back({b, a + k_columns, b + k_columns});
    }
  return s;
}

/// Upright, 1 m x 1 m, facing +Z.
Surface square(float z) {
  Surface s;
  s.positions = {{-0.5f, 0.5f, z}, {0.5f, 0.5f, z}, {0.5f, 1.5f, z}, {-0.5f, 1.5f, z}};
  s.normals.assign(4, Vec3f::UnitZ());
  s.triangles = {{0, 1, 2}, {0, 2, 3}};
  return s;
}

FrameView frame(std::vector<SurfaceView> surfaces, bool ground = false) {
  FrameView view;
  view.surfaces = std::move(surfaces);
  view.ground = ground;
  return view;
}

Camera camera_from(float z) { return {.eye = {0, 1, z}, .target = {0, 1, 0}}; }

class Picture : public ::testing::Test {
protected:
  void SetUp() override {
    if (const std::string missing = test::missing_opengl(); !missing.empty()) GTEST_SKIP() << missing;
    offscreen_.emplace(OffscreenOptions{.width = k_width, .height = k_height});
  }
  Image draw(const FrameView& view, const Camera& camera) { return offscreen_->draw(view, camera); }

  std::optional<Offscreen> offscreen_;
};

int difference(const std::uint8_t* a, const std::uint8_t* b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

struct Spot {
  int pixels = 0;
  Eigen::Vector2f centre = Eigen::Vector2f::Zero();
};

/// Where two pictures differ clearly.
Spot changed(const Image& a, const Image& b) {
  Spot spot;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      if (difference(a.at(x, y), b.at(x, y)) > 12) {
        ++spot.pixels;
        spot.centre += Eigen::Vector2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      }
  if (spot.pixels > 0) spot.centre /= static_cast<float>(spot.pixels);
  return spot;
}

const std::uint8_t* middle(const Image& image) { return image.at(k_width / 2, k_height / 2); }

TEST_F(Picture, IsNotBlank_slow) {
  const Surface ball = sphere({0, 1, 0}, 0.5f);
  const Image image = draw(frame({ball.view({0.8f, 0.1f, 0.1f})}, true), camera_from(4));
  ASSERT_EQ(image.pixels.size(), 3u * k_width * k_height);
  EXPECT_GT(difference(middle(image), image.at(5, 5)), 100);
  EXPECT_GT(middle(image)[0], middle(image)[1] + 60); // red
  EXPECT_GT(image.at(5, 5)[1], 120);                  // a bright studio
}

TEST_F(Picture, ASphereIsWhereTheCameraSaysItIs_slow) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> spread(-0.9f, 0.9f);
  for (int i = 0; i < 20; ++i) {
    const Vec3f centre(spread(engine), 1 + 0.7f * spread(engine), spread(engine));
    const Camera camera{.eye = {4 * spread(engine), 1 + spread(engine), 5}, .target = {0, 1, 0}};
    const Surface ball = sphere(centre, 0.04f);
    const Spot spot = changed(draw(frame({ball.view({0.1f, 0.1f, 0.3f})}), camera), draw(frame({}), camera));
    const auto pixel = project(camera, k_width, k_height, centre);
    ASSERT_TRUE(pixel);
    ASSERT_GT(spot.pixels, 4);
    EXPECT_LT((spot.centre - *pixel).norm(), 1.0f) << centre.transpose();
  }
}

TEST_F(Picture, HasTheSameBytesEachTime_slow) {
  const Surface ball = sphere({0, 0.5f, 0}, 0.5f), sheet = square(0.7f);
  FrameView view = frame({ball.view({0.8f, 0.5f, 0.4f}), sheet.view({0.1f, 0.3f, 0.5f})}, true);
  view.surfaces[1].two_sided = true;
  view.surfaces[1].wireframe = true;
  view.capsules = {{{-1, 1, 0}, {1, 1.2f, 0}, 0.2f}};
  view.lines = {{{0, 0, 0}, {0, 2, 0}}};
  view.points = sheet.positions;
  const Image once = draw(view, camera_from(4)), again = draw(view, camera_from(4));
  EXPECT_EQ(once.pixels, again.pixels);
  Offscreen other({.width = k_width, .height = k_height});
  EXPECT_EQ(once.pixels, other.draw(view, camera_from(4)).pixels);
}

TEST_F(Picture, TheNearerSurfaceIsSeenWhicheverComesFirst_slow) {
  const Surface near = square(0.5f), far = square(-0.5f);
  const SurfaceView red = near.view({0.7f, 0.02f, 0.02f}), blue = far.view({0.02f, 0.02f, 0.7f});
  for (const FrameView& view : {frame({red, blue}), frame({blue, red})}) {
    const Image image = draw(view, camera_from(4));
    EXPECT_GT(middle(image)[0], middle(image)[2] + 60);
  }
}

TEST_F(Picture, ATwoSidedSheetIsSeenFromBehindAndDarker_slow) {
  const Surface sheet = square(0);
  const Image empty = draw(frame({}), camera_from(-4));
  EXPECT_EQ(changed(draw(frame({sheet.view({0.5f, 0.1f, 0.1f})}), camera_from(-4)), empty).pixels, 0);
  FrameView view = frame({sheet.view({0.5f, 0.1f, 0.1f})});
  view.surfaces[0].two_sided = true;
  view.surfaces[0].offset = 0.001f;
  const Image behind = draw(view, camera_from(-4)), before = draw(view, camera_from(4));
  EXPECT_GT(changed(behind, empty).pixels, 1000);
  EXPECT_LT(middle(behind)[0] + 20, middle(before)[0]);
}

TEST_F(Picture, AnOffsetSheetHidesTheSkinItLiesOn_slow) {
  const Surface sheet = square(0);
  FrameView view =
      frame({sheet.view({0.02f, 0.7f, 0.02f}), sheet.view({0.7f, 0.02f, 0.02f})}); // skin, cloth: one place
  view.surfaces[1].two_sided = true;
  view.surfaces[1].offset = 0.002f;
  const Image image = draw(view, camera_from(4));
  for (int x = k_width / 2 - 20; x < k_width / 2 + 20; ++x)
    for (int y = k_height / 2 - 20; y < k_height / 2 + 20; ++y) EXPECT_GT(image.at(x, y)[0], image.at(x, y)[1]);
}

TEST_F(Picture, ABallThrowsAShadowOnTheFloor_slow) {
  const Surface ball = sphere({0, 0.3f, 0}, 0.3f);
  const Camera camera{.eye = {0, 3, 3}, .target = {0, 0, 0}};
  const Image image = draw(frame({ball.view({0.8f, 0.8f, 0.8f})}, true), camera);
  const auto at = [&](const Vec3f& p) {
    const Eigen::Vector2f pixel = project(camera, k_width, k_height, p).value();
    return int{image.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()))[1]};
  };
  // The light comes from the front left, so the shadow falls to the back right.
  EXPECT_GT(at({-0.6f, 0, 0.6f}), at({0.35f, 0, -0.35f}) + 30);
}

TEST_F(Picture, ACapsuleShowsThroughTheSkinAndStrongerBeforeIt_slow) {
  const Surface sheet = square(0);
  const SurfaceView skin = sheet.view({0.6f, 0.6f, 0.6f});
  const Image plain = draw(frame({skin}), camera_from(4));
  FrameView inside = frame({skin}), outside = frame({skin});
  inside.capsules = {{{-0.2f, 1, -0.3f}, {0.2f, 1, -0.3f}, 0.1f, 0.1f, {0.9f, 0.2f, 0.05f}}};
  outside.capsules = {{{-0.2f, 1, 0.3f}, {0.2f, 1, 0.3f}, 0.1f, 0.1f, {0.9f, 0.2f, 0.05f}}};
  const int weak = difference(middle(draw(inside, camera_from(4))), middle(plain));
  const int strong = difference(middle(draw(outside, camera_from(4))), middle(plain));
  EXPECT_GT(weak, 25);
  EXPECT_GT(strong, weak + 25);
}

TEST_F(Picture, AConeCoversThePixelsOfItsBalls_slow) {
  FrameView view = frame({});
  const Camera camera = camera_from(4);
  const Image empty = draw(view, camera);
  const Vec3f a(-0.4f, 0.8f, 0.1f);
  for (const auto& [b, radius_a, radius_b] :
       {std::tuple(Vec3f(0.3f, 1.2f, -0.2f), 0.05f, 0.3f), std::tuple(Vec3f(0.3f, 1.2f, -0.2f), 0.35f, 0.1f),
        std::tuple(Vec3f(-0.3f, 0.9f, 0.1f), 0.05f, 0.3f)}) { // one ball holds both
    view.capsules = {{a, b, radius_a, radius_b, {0.9f, 0.2f, 0.05f}}};
    const Image image = draw(view, camera);
    std::vector<float> nearest(static_cast<std::size_t>(k_width) * k_height, 1e9f); // pixels beyond any ball's outline
    for (int k = 0; k <= 200; ++k) {
      const float t = static_cast<float>(k) / 200.0f, radius = (1 - t) * radius_a + t * radius_b;
      const Vec3f centre = (1 - t) * a + t * b;
      const auto middle_at = project(camera, k_width, k_height, centre);
      // A ball's outline is seen along rays that touch it: a little wider than at its centre's distance.
      const Vec3f to_eye = camera.eye - centre;
      const float wide = radius / std::sqrt(1.0f - radius * radius / to_eye.squaredNorm());
      const auto side_at =
          project(camera, k_width, k_height, centre + wide * to_eye.cross(Vec3f::UnitX()).normalized());
      ASSERT_TRUE(middle_at && side_at);
      const float pixels = (*side_at - *middle_at).norm();
      for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x) {
          const Eigen::Vector2f pixel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
          float& least = nearest[static_cast<std::size_t>(y) * k_width + x];
          least = std::min(least, (pixel - *middle_at).norm() - pixels);
        }
    }
    int inside = 0;
    for (int y = 0; y < k_height; ++y)
      for (int x = 0; x < k_width; ++x) {
        const float beyond = nearest[static_cast<std::size_t>(y) * k_width + x];
        if (std::abs(beyond) < 2.0f) continue; // perspective makes outlines ellipses, and the mesh has corners
        EXPECT_EQ(difference(image.at(x, y), empty.at(x, y)) > 12, beyond < 0.0f) << x << ' ' << y;
        inside += beyond < 0.0f;
      }
    EXPECT_GT(inside, 500);
  }
}

TEST_F(Picture, LinesLieOverEverything_slow) {
  const Surface sheet = square(0);
  FrameView view = frame({sheet.view({0.6f, 0.6f, 0.6f})});
  const Image plain = draw(view, camera_from(4));
  view.lines = {{{-0.4f, 1, -2}, {0.4f, 1, -2}, {0.9f, 0, 0}}};
  EXPECT_GT(changed(draw(view, camera_from(4)), plain).pixels, 15);
  view.lines = {{{0, 1, 9}, {0, 1, 5}, {0.9f, 0, 0}}}; // all behind the eye
  EXPECT_EQ(changed(draw(view, camera_from(4)), plain).pixels, 0);
}

TEST_F(Picture, PointsAreHiddenByWhatIsBeforeThem_slow) {
  const Surface sheet = square(0);
  FrameView view = frame({sheet.view({0.6f, 0.6f, 0.6f})});
  const Image plain = draw(view, camera_from(4));
  view.points = {{0.1f, 1.1f, -0.2f}};
  EXPECT_EQ(changed(draw(view, camera_from(4)), plain).pixels, 0);
  view.points = {{0.1f, 1.1f, 0.0f}};
  EXPECT_GT(changed(draw(view, camera_from(4)), plain).pixels, 3);
}

TEST_F(Picture, ColoursOfPositionsAreShown_slow) {
  const Surface sheet = square(0);
  const std::vector<Colour> colours(4, Colour{0.02f, 0.6f, 0.02f});
  FrameView view = frame({sheet.view({0.6f, 0.02f, 0.02f})});
  view.surfaces[0].colours = colours;
  const Image image = draw(view, camera_from(4));
  EXPECT_GT(middle(image)[1], middle(image)[0] + 60);
}

TEST_F(Picture, SurvivesNonsense_slow) {
  Surface broken = square(0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  broken.positions[1] = {nan, nan, nan};
  broken.positions[2] = {3e38f, -3e38f, 3e38f};
  FrameView view = frame({broken.view({0.6f, 0.6f, 0.6f})}, true);
  view.surfaces[0].two_sided = true;
  view.points = broken.positions;
  view.capsules = {{{nan, 0, 0}, {0, 0, 0}, nan}};
  view.lines = {{{nan, 0, 0}, {0, 1e38f, 0}}};
  EXPECT_EQ(draw(view, camera_from(4)).pixels.size(), 3u * k_width * k_height);

  Surface wrong = square(0);
  wrong.triangles.push_back({0, 1, 4});
  EXPECT_THROW(draw(frame({wrong.view({})}), camera_from(4)), std::invalid_argument);
  wrong = square(0);
  wrong.normals.pop_back();
  EXPECT_THROW(draw(frame({wrong.view({})}), camera_from(4)), std::invalid_argument);
}

TEST_F(Picture, ASurfaceMayChangeItsTriangles_slow) {
  const Surface sheet = square(0), ball = sphere({0, 1, 0}, 0.2f);
  const Image first = draw(frame({sheet.view({0.6f, 0.1f, 0.1f})}), camera_from(4));
  draw(frame({ball.view({0.6f, 0.1f, 0.1f}), sheet.view({0.1f, 0.1f, 0.6f})}), camera_from(4));
  EXPECT_EQ(draw(frame({sheet.view({0.6f, 0.1f, 0.1f})}), camera_from(4)).pixels, first.pixels);
}

TEST_F(Picture, SupersamplingSoftensEdgesAndKeepsTheRest_slow) {
  const Surface ball = sphere({0, 1, 0}, 0.5f);
  const FrameView view = frame({ball.view({0.1f, 0.1f, 0.3f})});
  Offscreen fine({.width = k_width, .height = k_height, .supersample = 2});
  const Image coarse = draw(view, camera_from(4)), smooth = fine.draw(view, camera_from(4));
  EXPECT_LE(difference(middle(coarse), middle(smooth)), 6);
  const int softened = changed(coarse, smooth).pixels;
  EXPECT_GT(softened, 20);
  EXPECT_LT(softened, 2000); // about the outline's length
}

TEST(OffscreenSizes, OutOfRangeAreRefused_slow) {
  if (const std::string missing = test::missing_opengl(); !missing.empty()) GTEST_SKIP() << missing;
  EXPECT_THROW(Offscreen({.width = 0, .height = 10}), std::invalid_argument);
  EXPECT_THROW(Offscreen({.width = 10, .height = 9000}), std::invalid_argument);
  EXPECT_THROW(Offscreen({.width = 10, .height = 10, .supersample = 5}), std::invalid_argument);
}

TEST(Png, ComesBackAsItWas) {
  Image image{.width = 5, .height = 3, .pixels = {}};
  for (int i = 0; i < 45; ++i) image.pixels.push_back(static_cast<std::uint8_t>(i * 5));
  const auto folder = test::scratch_folder();
  write_png(folder / "a.png", image);
  const std::string bytes = read_file(folder / "a.png");
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                          static_cast<int>(bytes.size()), &width, &height, &channels, 3);
  ASSERT_NE(pixels, nullptr);
  EXPECT_EQ(width, 5);
  EXPECT_EQ(height, 3);
  EXPECT_EQ(std::vector<std::uint8_t>(pixels, pixels + 45), image.pixels);
  stbi_image_free(pixels);
  EXPECT_THROW(write_png(folder / "no" / "such" / "folder.png", image), std::runtime_error);
  EXPECT_THROW(write_png(folder / "empty.png", Image{}), std::runtime_error);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace tutu::app
