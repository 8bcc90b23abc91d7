// What is drawn of a run, and that drawing changes nothing of it.
#include "src/scene/load.h"
#include "src/view/play/scene_player.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>

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

TEST(Session, DrawingDoesNotChangeTheRun) {
  const LoadedScene& scene = dance();
  Session plain(scene), drawn(scene);
  SceneView view(scene);
  Layers all;
  all.particles = all.skeleton = all.proxies = all.wireframe = true;
  plain.start(rest_of(scene));
  drawn.start(rest_of(scene));
  for (int frame = 0; frame < 3; ++frame) {
    plain.advance();
    drawn.advance();
    drawn.skin_body();
    const FrameView picture = view.frame(drawn, all);
    EXPECT_EQ(picture.capsules.size(), scene.proxies.size());
    EXPECT_EQ(picture.points.size(), 900u + 225u);
    EXPECT_EQ(picture.surfaces.size(), 4u);
    EXPECT_EQ(picture.lines.size(), 51u);
  }
  EXPECT_EQ(plain.state_hash(), drawn.state_hash());
}

TEST(ScenePlayer, GoesOnAndBackAndShowsTheSameFrames) {
  const LoadedScene& scene = dance();
  Session session(scene);
  session.start(rest_of(scene));
  std::vector<std::uint64_t> hashes = {session.state_hash()};
  for (int frame = 0; frame < 6; ++frame) {
    session.advance();
    hashes.push_back(session.state_hash());
  }
  ScenePlayer player(scene, rest_of(scene), 6);
  int shown = 0;
  for (const int way : {3, -2, 4, -1, 100, -100, 5}) {
    player.go(way);
    shown = std::clamp(shown + way, 0, 6);
    while (player.behind()) (void)player.views({.body = false});
    EXPECT_EQ(player.figures().front().frame, shown);
    EXPECT_EQ(player.figures().front().state_hash, hashes[shown]) << shown;
    EXPECT_NEAR(player.time(), shown * session.frame_seconds(), 1e-12);
    EXPECT_EQ(player.at_end(), shown == 6);
  }
  player.rewind();
  EXPECT_EQ(player.figures().front().state_hash, hashes[0]);
  player.seek(2 * session.frame_seconds());
  EXPECT_EQ(player.figures().front().state_hash, hashes[2]);
  EXPECT_TRUE(player.why().front().empty());
  player.pick(0, 100);
  EXPECT_EQ(player.why_shown()->frame, 2);
  EXPECT_EQ(player.why_shown()->particle, 100);
}

} // namespace
