// Camera maths, the orbiting hand, and the pace of the window.
#include "src/view/render/camera.h"
#include "src/view/window/orbit.h"
#include "src/view/window/pacing.h"

#include <gtest/gtest.h>
#include <random>

namespace tutu::app {
namespace {

class Random {
public:
  float uniform(float lo, float hi) { return std::uniform_real_distribution<float>(lo, hi)(engine_); }
  Vec3f point(float reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}; }

private:
  std::mt19937 engine_{7};
};

TEST(Camera, ProjectionAgreesWithTheMatrices) {
  Random random;
  int seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3f eye = random.point(5);
    const Camera camera{.eye = eye, .target = eye + random.point(1), .vertical_fov = random.uniform(0.2f, 1.5f)};
    const Vec3f point = random.point(6);
    const Eigen::Vector4f clip = clip_from_view(camera, 1280.0f / 720.0f, 0.01f, 50.0f) * view_from_world(camera) *
                                 Eigen::Vector4f(point.x(), point.y(), point.z(), 1);
    const auto pixel = project(camera, 1280, 720, point);
    EXPECT_EQ(pixel.has_value(), clip.w() > 0);
    if (!pixel || clip.w() < 0.1f) continue;
    ++seen;
    const float tolerance = 1e-3f * (1280 + pixel->cwiseAbs().maxCoeff());
    EXPECT_NEAR(pixel->x(), (0.5f + 0.5f * clip.x() / clip.w()) * 1280, tolerance);
    EXPECT_NEAR(pixel->y(), (0.5f - 0.5f * clip.y() / clip.w()) * 720, tolerance);
  }
  EXPECT_GT(seen, 600);
  EXPECT_LT(seen, 1400);
}

TEST(Camera, DepthRunsFromNearToFar) {
  const Camera camera{.eye = {0, 0, 0}, .target = {0, 0, -1}};
  const Mat4f clip = clip_from_view(camera, 1, 0.5f, 20);
  const auto depth = [&](float distance) {
    const Eigen::Vector4f c = clip * Eigen::Vector4f(0, 0, -distance, 1);
    return c.z() / c.w();
  };
  EXPECT_NEAR(depth(0.5f), -1, 1e-5);
  EXPECT_NEAR(depth(20), 1, 1e-5);
  EXPECT_LT(depth(3), depth(4));
}

TEST(Camera, TheTargetIsInTheMiddleAndUpIsUp) {
  const Camera camera{.eye = {3, 2, 4}, .target = {0.5f, 1, 0}};
  const auto middle = project(camera, 640, 480, camera.target);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->x(), 320, 1e-2);
  EXPECT_NEAR(middle->y(), 240, 1e-2);
  EXPECT_LT(project(camera, 640, 480, camera.target + Vec3f(0, 0.1f, 0))->y(), 239);
}

TEST(Camera, LooksStraightDownWithoutNaN) {
  const Camera camera{.eye = {0, 5, 0}, .target = {0, 0, 0}};
  EXPECT_TRUE(view_from_world(camera).allFinite());
  EXPECT_LT(project(camera, 100, 100, {0, 0, -1})->y(), 50); // -z upwards in the picture
}

TEST(Camera, FramedBoxFillsThePictureAndStaysInside) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Vec3f lo = random.point(3),
                hi = lo + Vec3f(random.uniform(0.1f, 2), random.uniform(0.1f, 2), random.uniform(0.1f, 2));
    const float aspect = random.uniform(0.5f, 2.5f);
    const int height = 1000, width = static_cast<int>(aspect * 1000);
    const Camera camera = frame_camera(lo, hi, random.uniform(-3, 3), random.uniform(-1.4f, 1.4f), aspect);
    float widest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f point((corner & 1 ? hi : lo).x(), (corner & 2 ? hi : lo).y(), (corner & 4 ? hi : lo).z());
      const auto pixel = project(camera, width, height, point);
      ASSERT_TRUE(pixel);
      widest = std::max({widest, std::abs(pixel->x() / static_cast<float>(width) - 0.5f),
                         std::abs(pixel->y() / static_cast<float>(height) - 0.5f)});
    }
    EXPECT_LT(widest, 0.5f);
    EXPECT_GT(widest, 0.42f);
  }
}

TEST(Orbit, AFramedOrbitIsTheFramedCamera) {
  const Vec3f lo(-0.5f, 0, -0.3f), hi(0.5f, 1.7f, 0.3f);
  const Camera camera = frame_camera(lo, hi, 0.4f, 0.2f, 1.5f), orbit = frame_orbit(lo, hi, 0.4f, 0.2f, 1.5f).camera();
  EXPECT_LT((camera.eye - orbit.eye).norm(), 1e-5f);
  EXPECT_LT((camera.target - orbit.target).norm(), 1e-6f);
}

TEST(Orbit, AFullTurnComesBack) {
  OrbitCamera orbit;
  const Vec3f eye = orbit.camera().eye;
  for (int i = 0; i < 200; ++i) rotate(orbit, 8, 0, 800); // 1600 px of 800 px height: two half turns
  EXPECT_LT((orbit.camera().eye - eye).norm(), 1e-3f);
}

TEST(Orbit, TheFrontFollowsTheHand) {
  OrbitCamera orbit;
  orbit.yaw = orbit.pitch = 0;
  const Vec3f nose = orbit.target + Vec3f(0, 0, 0.1f);
  const float before = project(orbit.camera(), 800, 800, nose)->x();
  rotate(orbit, 30, 0, 800);
  EXPECT_GT(project(orbit.camera(), 800, 800, nose)->x(), before + 1);
}

TEST(Orbit, PanKeepsTheTargetsPlaneUnderThePointer) {
  OrbitCamera orbit;
  const Vec3f mark = orbit.target;
  pan(orbit, 37, -21, 720);
  const auto pixel = project(orbit.camera(), 1280, 720, mark);
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 640 + 37, 0.1);
  EXPECT_NEAR(pixel->y(), 360 - 21, 0.1);
}

TEST(Orbit, StaysInItsLimits) {
  OrbitCamera orbit;
  rotate(orbit, 0, 1e6f, 720);
  EXPECT_LT(orbit.pitch, 1.51f);
  zoom(orbit, 1e4f);
  EXPECT_GT(orbit.distance, 0.04f);
  zoom(orbit, -1e4f);
  EXPECT_LT(orbit.distance, 101.0f);
  EXPECT_TRUE(orbit.camera().eye.allFinite());
}

TEST(Pacing, KeepsUpWithTheClock) {
  Pacing pacing;
  int steps = 0;
  for (int frame = 0; frame < 600; ++frame) steps += pacing.steps_due(1.0 / 60, 1, 1.0 / 30, 4);
  EXPECT_NEAR(steps, 300, 1);
}

TEST(Pacing, OneStepAPictureWhenBothHaveTheSameRate) {
  Pacing pacing;
  for (int frame = 0; frame < 1000; ++frame) EXPECT_EQ(pacing.steps_due(1.0 / 60, 1, 1.0 / 60, 4), 1) << frame;
}

TEST(Pacing, ForgetsWhatCannotBeCaughtUp) {
  Pacing pacing;
  EXPECT_EQ(pacing.steps_due(10, 1, 1.0 / 60, 4), 4);
  EXPECT_LE(pacing.steps_due(0, 1, 1.0 / 60, 4), 1);
  EXPECT_EQ(pacing.steps_due(0, 1, 1.0 / 60, 4), 0);
}

TEST(Camera, ARayGoesThroughThePixelItIsAskedFor) {
  const Camera camera{.eye = {1, 2, 3}, .target = {0.2f, 0.9f, -0.4f}, .vertical_fov = 0.7f};
  for (const Eigen::Vector2f& pixel : {Eigen::Vector2f(10, 20), Eigen::Vector2f(320, 240), Eigen::Vector2f(600, 470)}) {
    const Vec3f way = ray_through(camera, 640, 480, pixel);
    EXPECT_NEAR(way.norm(), 1.0f, 1e-6f);
    const auto back = project(camera, 640, 480, camera.eye + 3.0f * way);
    ASSERT_TRUE(back);
    EXPECT_LT((*back - pixel).norm(), 0.01f);
  }
}

} // namespace
} // namespace tutu::app
