// Garments without rows and columns in a scene: played, drawn, draped, saved.
#include "cloth/garment/drape_file.h"
#include "rig/io/file_io.h"
#include "src/run/drape.h"
#include "src/scene/load.h"
#include "src/scene/saved_drape.h"
#include "src/view/show/scene_view.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

/// The dance in a round skirt, held by the skin around the hole in its middle, and in a kerchief from a file.
LoadedScene ballet(const std::filesystem::path& folder, const std::string& solver) {
  write_file(folder / "tutu.json",
             R"({"shape": {"disc": {"centre": [0, 1.02, 0], "radius": 0.4, "hole": 0.12, "rings": 8}},
    "fabric": {"stretch": 60, "bend": 1e-4},
    "attachments": [{"skin": true, "within": {"centre": [0, 1.02, 0], "radius": 0.13}}]})");
  write_file(folder / "cloth.obj", "v -10 130 15\nv 10 130 15\nv 10 120 20\nv -10 120 20\nf 4 3 2 1\n");
  write_file(folder / "kerchief.json", R"({"shape": {"mesh": {"file": "cloth.obj", "scale": 0.01}},
    "attachments": [{"joint": "Spine2", "above": 1.29}]})");
  const std::string assets = source_file("assets").string();
  write_file(folder / "scene.json", R"({"character": ")" + assets + R"(/characters/dancer.dae", "motion": ")" + assets +
                                        R"(/poses/dance.json", "proxies": ")" + assets +
                                        R"(/proxies/dancer.json", "garments": ["tutu.json", "kerchief.json"],
                                        "solver": {"name": ")" +
                                        solver + R"(", "substeps": 16}})");
  return load_scene(read_scene(folder / "scene.json"));
}

TEST(MeshGarment, PlaysAndIsDrawnWithEitherSolver) {
  const auto folder = scratch_folder();
  for (const std::string solver : {"xpbd", "mass_spring"}) {
    const LoadedScene scene = ballet(folder, solver);
    ASSERT_EQ(scene.garments[0].rows, 0);
    EXPECT_EQ(scene.garments[0].pins.size(), scene.skin_pins[0].bindings.size());
    EXPECT_EQ(scene.garments[1].pins.size(), 2u);
    Session session(scene);
    session.start({scene.garments[0].rest_positions, scene.garments[1].rest_positions});
    SceneView view(scene);
    Layers layers;
    layers.body = false;
    layers.cloth = layers.particles = true;
    for (int frame = 0; frame < 30; ++frame) {
      session.advance();
      ASSERT_FALSE(session.failure().has_value()) << solver << ": " << session.failure()->message();
      const FrameView drawn = view.frame(session, layers);
      ASSERT_EQ(drawn.surfaces.size(), 2u);
      EXPECT_EQ(drawn.surfaces[0].triangles.size(), scene.garments[0].triangles.size());
      EXPECT_EQ(drawn.points.size(), scene.garments[0].rest_positions.size() + 4u);
      for (const Vec3f& normal : drawn.surfaces[0].normals) EXPECT_NEAR(normal.norm(), 1.0f, 1e-5f);
    }
    session.jump(1.0);
    session.advance();
    EXPECT_FALSE(session.failure().has_value());
  }
  std::filesystem::remove_all(folder);
}

TEST(MeshGarment, ADrapeIsOutOfDateWhenTheRigidityChanges) {
  const auto folder = scratch_folder();
  LoadedScene scene = ballet(folder, "xpbd");
  const DrapeResult result = drape(scene, 0.3, [](int, int) { return true; });
  ASSERT_FALSE(result.failure.has_value());
  cloth::Drape saved{drape_fingerprint(scene), {}};
  for (int g = 0; g < 2; ++g) saved.garments.push_back({scene.garments[g].name, result.positions[g]});
  cloth::write_drape(saved, scene.files.drape);
  bool stale = true;
  EXPECT_TRUE(saved_drape(scene, &stale).has_value());
  EXPECT_FALSE(stale);
  scene.garments[0].fabric.bend *= 1.01;
  EXPECT_FALSE(saved_drape(scene, &stale).has_value());
  EXPECT_TRUE(stale);
  std::filesystem::remove_all(folder);
}

} // namespace
