// What an engine calls: joints and seconds in, positions and normals out.
#include "cloth/garment/garment_file.h"
#include "rig/io/file_io.h"
#include "src/run/drape.h"
#include "src/run/runtime.h"
#include "src/run/session.h"
#include "src/scene/load.h"
#include "tests/support/counted_allocations.h"
#include "tests/support/paths.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::app;

namespace {

class RuntimeTest : public ::testing::Test {
protected:
  RuntimeTest() : scene_(load_scene(read_scene(test::write_small_scene(folder_)))) {
    local_ = scene_.character.skeleton.rest_local;
    joints_.resize(local_.size());
  }
  ~RuntimeTest() override { std::filesystem::remove_all(folder_); }

  const std::vector<Transform>& joints_at(double time) {
    rig::pose_at(scene_.motion, scene_.character.skeleton, time, local_, joints_);
    return joints_;
  }
  GarmentPositions at_rest() const { return {scene_.garments[0].rest_positions}; }

  std::filesystem::path folder_ = test::scratch_folder();
  LoadedScene scene_;
  std::vector<Transform> local_, joints_;
  const double h_ = 1.0 / 60.0;
};

TEST_F(RuntimeTest, OfAWearerMadeInMemoryHasTheBitsOfASession) {
  Wearer wearer;
  wearer.settings = scene_.settings;
  wearer.character = scene_.character;
  wearer.proxies = scene_.proxies;
  wearer.put_on(cloth::read_garment(folder_ / "sheet.json"));
  const auto first = rig::first_pose(scene_.motion);
  const DrapeResult draped = drape(wearer, first, 0.5, [](int, int) { return true; });
  EXPECT_EQ(draped.positions, drape(scene_, 0.5, [](int, int) { return true; }).positions);

  Runtime runtime(wearer);
  Session session(scene_);
  runtime.start(joints_at(0.0), draped.positions);
  session.start(draped.positions);
  for (int frame = 0; frame < 30; ++frame) {
    runtime.step(joints_at(session.time() + h_), h_);
    session.advance();
    ASSERT_EQ(runtime.state_hash(), session.state_hash()) << frame;
  }
  EXPECT_EQ(runtime.time(), session.time());
  EXPECT_EQ(runtime.frame(), 30);
}

TEST_F(RuntimeTest, FramesOfAnyLengthTakeSubstepsOfTheSameLength) {
  Runtime runtime(scene_);
  runtime.start(joints_at(0.0), at_rest());
  double time = 0.0;
  const auto step = [&](double seconds, int substeps) {
    time += seconds;
    runtime.step(joints_at(0.0), seconds);
    EXPECT_EQ(runtime.garment(0).substeps(), substeps) << seconds;
    EXPECT_NEAR(runtime.time(), time, 1e-12);
  };
  step(h_, 8); // as the scene says
  step(2 * h_, 16);
  step(0.5 * h_, 4);
  step(0.51 * h_, 5);
  step(1e-4, 1);
  step(1.0, 480);
  EXPECT_EQ(runtime.frame(), 6);
  EXPECT_FALSE(runtime.failure());
}

/// However it is cut into frames, cloth swings as far in the same time.
TEST_F(RuntimeTest, TheMotionDoesNotDependOnTheRateOfFrames) {
  const auto run = [&](double seconds, int frames) {
    Runtime runtime(scene_);
    runtime.start(joints_at(0.0), at_rest());
    for (int k = 1; k <= frames; ++k) runtime.step(joints_at(k * seconds), seconds);
    return std::vector<Vec3>(runtime.positions(0).begin(), runtime.positions(0).end());
  };
  const std::vector<Vec3> slow = run(2 * h_, 6), usual = run(h_, 12), fast = run(0.5 * h_, 24);
  for (std::size_t i = 0; i < usual.size(); ++i) {
    EXPECT_LT((slow[i] - usual[i]).norm(), 0.01) << i;
    EXPECT_LT((fast[i] - usual[i]).norm(), 0.01) << i;
  }
}

TEST_F(RuntimeTest, AWarmFrameAllocatesNothing) {
  Runtime runtime(scene_);
  runtime.start(joints_at(0.0), at_rest());
  std::vector<Vec3> normals(scene_.garments[0].particle_count());
  long before = 0;
  for (int frame = 1; frame <= 120; ++frame) {
    if (frame == 61) before = test::allocations;
    runtime.step(joints_at(frame * h_), frame % 2 ? h_ : 0.7 * h_);
    runtime.normals(0, normals);
    if (frame % 20 == 0) runtime.jump(joints_at(0.0), 0.0);
  }
  EXPECT_EQ(test::allocations - before, 0);
  EXPECT_FALSE(runtime.failure());
}

TEST_F(RuntimeTest, NormalsAreThoseOfTheTriangles) {
  Runtime runtime(scene_);
  std::vector<Vec3> normals(scene_.garments[0].particle_count());
  runtime.start(joints_at(0.0), at_rest());
  runtime.normals(0, normals);
  for (const Vec3& n : normals) EXPECT_NEAR(std::abs(n.y()), 1.0, 1e-12) << "a level sheet";
  for (int frame = 1; frame < 20; ++frame) runtime.step(joints_at(frame * h_), h_);
  runtime.normals(0, normals);
  const auto x = runtime.positions(0);
  // Each from the cell around it: rows and columns cross at right angles to it, about.
  for (int row = 1; row < 8; ++row)
    for (int column = 1; column < 8; ++column) {
      const int i = 9 * row + column;
      EXPECT_NEAR(normals[i].norm(), 1.0, 1e-12);
      const Vec3 across = (x[i + 1] - x[i - 1]).normalized(), down = (x[i + 9] - x[i - 9]).normalized();
      EXPECT_GT(std::abs(normals[i].dot(across.cross(down).normalized())), 0.9);
    }
}

TEST_F(RuntimeTest, AnEngineSetsTheWind) {
  scene_.garments[0].fabric.air = cloth::Air{};
  scene_.garments[0].fabric.drag = 0.0;
  const auto blown = [&](const auto& set) { // how far the sheet's middle went to +X, and the bits
    Runtime runtime(scene_);
    runtime.start(joints_at(0.0), at_rest());
    for (int frame = 1; frame < 40; ++frame) {
      set(runtime);
      runtime.step(joints_at(0.0), h_);
    }
    return std::pair(runtime.positions(0)[76].x() - scene_.garments[0].rest_positions[76].x(), runtime.state_hash());
  };
  const auto still = blown([](Runtime&) {});
  const auto set = blown([](Runtime& runtime) { runtime.set_wind({{8, 0, 0}}); });
  EXPECT_GT(set.first, still.first + 0.01);
  scene_.wind.velocity = {8, 0, 0};
  EXPECT_EQ(blown([](Runtime&) {}).second, set.second) << "as the wearer has it";
  scene_.wind.gusts = cloth::Gusts{3.0, 0.2, 1};
  const auto gusty = blown([](Runtime&) {});
  EXPECT_NE(gusty.second, set.second);
  EXPECT_EQ(blown([](Runtime&) {}).second, gusty.second);
  scene_.settings.threads = 2;
  EXPECT_EQ(blown([](Runtime&) {}).second, gusty.second);
  EXPECT_EQ(drape(scene_, 0.2, [](int, int) { return true; }).positions, [&] {
    LoadedScene steady = scene_;
    steady.wind.gusts.reset();
    return drape(steady, 0.2, [](int, int) { return true; }).positions;
  }()) << "draped without gusts";

  Runtime runtime(scene_);
  for (const cloth::Wind& none : {cloth::Wind{{60, 0, 0}}, cloth::Wind{{std::nan(""), 0, 0}},
                                  cloth::Wind{{}, cloth::Gusts{1.0, 0.0}}, cloth::Wind{{}, cloth::Gusts{-1.0, 1.0}}})
    EXPECT_THROW(runtime.set_wind(none), std::invalid_argument);
}

TEST_F(RuntimeTest, WhatIsNoFrameIsRefused) {
  Runtime runtime(scene_);
  runtime.start(joints_at(0.0), at_rest());
  for (const double seconds : {0.0, -h_, 1.5, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(runtime.step(joints_at(0.0), seconds), std::invalid_argument) << seconds;
  EXPECT_THROW(runtime.step(std::vector<Transform>(joints_.size() + 1), h_), std::invalid_argument);
  EXPECT_EQ(runtime.frame(), 0) << "nothing has happened";
  runtime.step(joints_at(h_), h_);
  EXPECT_EQ(runtime.frame(), 1);
}

TEST_F(RuntimeTest, AJumpCarriesGarmentsAlongAtRest) {
  Runtime runtime(scene_);
  runtime.start(joints_at(0.0), at_rest());
  for (int frame = 1; frame < 10; ++frame) runtime.step(joints_at(frame * h_), h_);
  const std::vector<Transform> from = joints_;
  const std::vector<Vec3> before(runtime.positions(0).begin(), runtime.positions(0).end());
  std::vector<Transform> to = from;
  const Transform moved(Quat(Eigen::AngleAxisd(1.0, Vec3::UnitY())), Vec3(3, 0, -2));
  for (Transform& joint : to) joint = moved * joint;
  runtime.jump(to, 7.0);
  EXPECT_EQ(runtime.time(), 7.0);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT((runtime.positions(0)[i] - moved * before[i]).norm(), 1e-12);
    EXPECT_EQ(runtime.garment(0).particles().velocities[i], Vec3::Zero());
  }
  runtime.step(to, h_);
  EXPECT_EQ(runtime.troubles().teleports, 0);
  for (Transform& joint : to) joint.translation += Vec3(0, 0, 4.0);
  runtime.step(to, h_);
  EXPECT_EQ(runtime.troubles().teleports, 1) << "what nobody told, but no motion";
}

} // namespace
