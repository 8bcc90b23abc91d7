// A run on a thread of its own, watched and steered from another: the bits are those of a session.
#include "src/run/simulation.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"
#include "tests/support/small_scene.h"

#include <gtest/gtest.h>

namespace tutu::app {
namespace {

class SimulationThread : public ::testing::Test {
protected:
  SimulationThread()
      : folder_(test::scratch_folder()),
        scene_(load_scene(read_scene(test::write_small_scene(folder_)))), start_{scene_.garments[0].rest_positions} {}
  ~SimulationThread() override { std::filesystem::remove_all(folder_); }

  std::uint64_t hash_after(int frames) const {
    Session session(scene_);
    session.start(start_);
    for (int f = 0; f < frames; ++f) session.advance();
    return session.state_hash();
  }

  std::filesystem::path folder_;
  LoadedScene scene_;
  GarmentPositions start_;
};

TEST_F(SimulationThread, EveryFrameHasTheBitsOfASession) {
  Simulation simulation(scene_, start_, 1 << 20);
  int asked = 0;
  while (simulation.extent().last < 30) { // somebody looks all the time, and asks for little by little
    simulation.run_until(std::min(30, ++asked));
    const auto newest = simulation.frame(simulation.extent().last);
    EXPECT_TRUE(!newest || newest->index <= 30);
    EXPECT_EQ(simulation.message(), "");
  }
  simulation.wait_for(30);
  EXPECT_EQ(simulation.extent().first, 0);
  EXPECT_EQ(simulation.extent().last, 30); // and not one further
  for (const int index : {0, 1, 17, 30}) EXPECT_EQ(state_hash(*simulation.frame(index)), hash_after(index)) << index;
  EXPECT_FALSE(simulation.frame(31));
  EXPECT_FALSE(simulation.frame(-1));
}

TEST_F(SimulationThread, StartsAgainWithTheSameBitsWheneverItIsTold) {
  Simulation simulation(scene_, start_, 1 << 20);
  const std::uint64_t expected = hash_after(12);
  for (int run = 0; run < 20; ++run) {
    simulation.run_until(40); // it is somewhere on the way when it is told
    simulation.jump(0);
    simulation.run_until(12);
    simulation.wait_for(12);
    ASSERT_EQ(state_hash(*simulation.frame(12)), expected) << run;
    EXPECT_EQ(simulation.extent().last, 12);
  }
}

TEST_F(SimulationThread, JumpsAndRecordsFromThere) {
  Simulation simulation(scene_, start_, 1 << 20);
  simulation.run_until(3);
  simulation.wait_for(3);
  simulation.jump(8);
  simulation.run_until(10);
  simulation.wait_for(10);
  EXPECT_EQ(simulation.extent().first, 8);
  EXPECT_NEAR(simulation.frame(8)->time, 8.0 / 60.0, 1e-12);
  EXPECT_FALSE(simulation.frame(3));
}

TEST_F(SimulationThread, TheOldestFramesGoWhenTheBoundIsReached) {
  Session session(scene_);
  session.start(start_);
  session.advance();
  FrameState one;
  capture(session, one);
  const std::size_t bound = 5 * one.bytes() + one.bytes() / 2;
  Simulation simulation(scene_, start_, bound);
  simulation.run_until(20);
  simulation.wait_for(20);
  const Simulation::Extent extent = simulation.extent();
  EXPECT_EQ(extent.last, 20);
  EXPECT_GT(extent.first, 20 - 8);
  EXPECT_LT(extent.first, 20);
  EXPECT_LE(extent.bytes, bound);
  const auto kept = simulation.frame(extent.first);
  simulation.run_until(40);
  simulation.wait_for(40);
  EXPECT_EQ(state_hash(*kept), hash_after(kept->index)); // a frame in somebody's hands stays
}

TEST_F(SimulationThread, MayBeLeftInTheMiddleOfAnything) {
  for (int run = 0; run < 20; ++run) {
    Simulation simulation(scene_, start_, 1 << 20);
    simulation.run_until(1000);
    if (run % 2) simulation.jump(5);
  }
}

} // namespace
} // namespace tutu::app
