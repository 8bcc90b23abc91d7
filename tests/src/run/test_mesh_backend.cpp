// Scenes that collide with the true body.
#include "cloth/detail/solver_parts.h"
#include "rig/error.h"
#include "src/run/drape.h"
#include "src/run/session.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

LoadedScene dance() {
  SceneDescription description = read_scene(source_file("assets/scenes/dance.json"));
  description.settings.backend = proxies::Backend::mesh;
  return load_scene(description);
}

/// How deep free particles are in the body as it is drawn, by a tree of its own and exact winding numbers, m.
double deepest_in_body(Session& session) {
  const Scene& scene = session.scene();
  session.skin_body();
  proxies::BodyMesh body(scene.character.mesh.positions, scene.character.mesh.triangles);
  body.pose(session.body_positions());
  double deepest = 0.0;
  for (std::size_t g = 0; g < scene.garments.size(); ++g) {
    const std::vector<std::uint8_t> pinned = cloth::pinned_flags(scene.garments[g]);
    const std::vector<Vec3>& positions = session.garment(static_cast<int>(g)).particles().positions;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (pinned[i]) continue;
      const double depth = -body.signed_distance(positions[i]).distance;
      if (i % 16 == 0) {
        EXPECT_EQ(body.winding_number(positions[i]) > 0.5, depth > 0.0);
      }
      deepest = std::max(deepest, depth);
    }
  }
  return deepest;
}

TEST(MeshBackend, NoParticleIsInTheTrueBody) {
  const LoadedScene scene = dance();
  Session session(scene);
  EXPECT_EQ(session.backend(), "mesh");
  std::vector<Transform> local = scene.character.skeleton.rest_local; // where the garments were built
  for (int frame = 0; frame < 2; ++frame) {
    local[0].translation.z() += 0.01;
    session.advance_to(local, 4.0);
    EXPECT_LT(deepest_in_body(session), 1e-6);
    for (int g = 0; g < 2; ++g)
      EXPECT_GT(session.contact_with_body(g, session.garment(g).particles().positions.back()).distance, 0.0);
  }
  EXPECT_FALSE(session.failure());
}

TEST(MeshBackend, NoParticleIsInTheTrueBodyOverTheDance_slow) {
  const LoadedScene scene = dance();
  const DrapeResult draped = drape(scene, 4.0, [](int, int) { return true; });
  Session session(scene);
  session.start(draped.positions);
  for (int frame = 0; frame < 720; ++frame) {
    session.advance();
    ASSERT_FALSE(session.failure());
    if (frame % 5 == 0) {
      EXPECT_LT(deepest_in_body(session), 0.0005) << "frame " << frame;
    }
  }
}

TEST(MeshBackend, ABodyWithoutSidesIsBadInput) {
  LoadedScene scene = dance();
  for (rig::Triangle& t : scene.character.mesh.triangles) std::swap(t[1], t[2]);
  try {
    const Session session(scene);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("dancer.dae: body mesh: found a body turned inside out, expected "
                                                   "triangles that run counter-clockwise seen from outside"));
  }
  scene.settings.backend = proxies::Backend::hybrid; // which never looks
  EXPECT_NO_THROW(Session{scene});
}

} // namespace
