// Garments of one scene stepped side by side by a session: the same bits as one after the other.
#include "src/run/session.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

/// The shipped dance with every garment twice.
LoadedScene crowded_dance(int threads) {
  LoadedScene scene = load_scene(read_scene(source_file("assets/scenes/dance.json")));
  scene.settings.threads = threads;
  const std::size_t count = scene.garments.size();
  for (std::size_t g = 0; g < count; ++g) {
    scene.garments.push_back(scene.garments[g]);
    scene.attachment_joints.push_back(scene.attachment_joints[g]);
    scene.skin_pins.push_back(scene.skin_pins[g]);
  }
  return scene;
}

std::uint64_t hash_after(const LoadedScene& scene, int frames) {
  Session session(scene);
  GarmentPositions start;
  for (const cloth::Garment& garment : scene.garments) start.push_back(garment.rest_positions);
  session.start(start);
  for (int frame = 0; frame < frames; ++frame) session.advance();
  EXPECT_FALSE(session.failure().has_value());
  EXPECT_EQ(session.frame(), frames);
  return session.state_hash();
}

TEST(Determinism, TheDanceOnAnyNumberOfThreads) {
  const LoadedScene scene = crowded_dance(1);
  const std::uint64_t expected = hash_after(scene, 40);
  EXPECT_EQ(hash_after(scene, 40), expected) << "run after run";
  for (const int threads : {2, 4, 64}) {
    const LoadedScene same = crowded_dance(threads);
    for (int run = 0; run < 3; ++run) EXPECT_EQ(hash_after(same, 40), expected) << threads << " threads";
  }
}

} // namespace
