// What a session does with joints: pins, jumps in time, restarts.
#include "src/run/session.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

const LoadedScene& dance() {
  static const LoadedScene scene = load_scene(read_scene(source_file("assets/scenes/dance.json")));
  return scene;
}

GarmentPositions rest_of(const Scene& scene) {
  GarmentPositions positions;
  for (const cloth::Garment& garment : scene.garments) positions.push_back(garment.rest_positions);
  return positions;
}

TEST(Session, PinsFollowTheirJointsRotationToo) {
  const LoadedScene& scene = dance();
  Session session(scene);
  session.start(rest_of(scene));
  const std::vector<Transform> rest = rig::rest_model(scene.character.skeleton);
  for (int frame = 0; frame < 3; ++frame) session.advance();
  ASSERT_FALSE(session.failure().has_value());
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (const cloth::Pin& pin : scene.garments[g].pins) {
      const int joint = scene.attachment_joints[g][pin.attachment];
      const Vec3 expected =
          session.world_from_joint()[joint] * (rest[joint].inverse() * scene.garments[g].rest_positions[pin.particle]);
      EXPECT_LT((session.garment(static_cast<int>(g)).particles().positions[pin.particle] - expected).norm(), 1e-12);
    }
}

TEST(Session, AJumpInTimeIsNeverSeenAsAVelocity) {
  const LoadedScene& scene = dance();
  Session session(scene);
  session.start(rest_of(scene));
  session.advance();
  session.jump(5.0);
  EXPECT_NEAR(session.time(), 5.0, 1e-12);
  for (int g = 0; g < 2; ++g)
    for (const Vec3& v : session.garment(g).particles().velocities) EXPECT_EQ(v, Vec3::Zero());
  const auto colliders = session.colliders().swept();
  for (int c = 0; c < colliders.size(); ++c) EXPECT_EQ(colliders.start[c].a, colliders.end[c].a);
  session.advance();
  EXPECT_FALSE(session.failure().has_value());
}

TEST(Session, RestartingGivesTheSameRun) {
  const LoadedScene& scene = dance();
  Session session(scene);
  session.start(rest_of(scene));
  for (int frame = 0; frame < 3; ++frame) session.advance();
  const std::uint64_t hash = session.state_hash();
  session.jump(3.0);
  session.start(rest_of(scene));
  for (int frame = 0; frame < 3; ++frame) session.advance();
  EXPECT_EQ(session.state_hash(), hash);
}

} // namespace
