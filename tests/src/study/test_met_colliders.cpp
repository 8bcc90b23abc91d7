// What a garment does not meet: it goes through, and nobody calls it deep.
#include "rig/error.h"
#include "src/measure/cloth_depths.h"
#include "src/run/frame_state.h"
#include "src/run/session.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::app;
using Which = cloth::MetColliders::Which;

namespace {

struct Fallen {
  double depth = 0.0;   ///< m, as ClothProbe has it, and
  double through = 0.0; ///< below the trunk's surface, whoever meets it
};

Fallen fallen(LoadedScene scene, const cloth::MetColliders& met, proxies::Backend backend, cloth::SolverKind solver) {
  scene.garments[0].met = met;
  scene.settings.backend = backend;
  scene.settings.solver = solver;
  if (solver == cloth::SolverKind::mass_spring) scene.settings.substeps = 100;
  Session session(scene);
  session.start({scene.garments[0].rest_positions});
  Fallen result;
  const ClothProbe probe(scene.garments[0]);
  for (int frame = 0; frame < 30; ++frame) {
    session.advance();
    EXPECT_FALSE(session.failure());
    FrameState state;
    capture(session, state);
    EXPECT_EQ(state.swept(0).meets(0), met.which == Which::all);
    const std::vector<Vec3>& x = session.garment(0).particles().positions;
    ClothDepths depths, through;
    probe.measure(session.colliders_of(0), x, depths);
    probe.measure(session.colliders().swept(), x, through);
    result.depth = std::max(result.depth, depths.surface);
    result.through = std::max(result.through, through.surface);
  }
  return result;
}

class MetColliders : public testing::Test {
protected:
  void SetUp() override { file_ = test::write_small_scene(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  LoadedScene scene() const { return load_scene(read_scene(file_)); }

  std::filesystem::path folder_ = test::scratch_folder();
  std::string file_;
};

TEST_F(MetColliders, AreLeftAloneByEverySolverAndBackend) {
  for (const auto backend : {proxies::Backend::hybrid, proxies::Backend::fcl, proxies::Backend::brute})
    for (const auto solver : {cloth::SolverKind::xpbd, cloth::SolverKind::mass_spring}) {
      const Fallen all = fallen(scene(), {}, backend, solver);
      EXPECT_LT(all.through, 0.002);
      const std::string proxy = scene().proxies[0].name;
      for (const cloth::MetColliders& met :
           {cloth::MetColliders{Which::all_but, {"Hips"}}, cloth::MetColliders{Which::all_but, {proxy}},
            cloth::MetColliders{Which::only, {}}}) {
        const Fallen without = fallen(scene(), met, backend, solver);
        EXPECT_GT(without.through, 0.02);
        EXPECT_EQ(without.depth, 0.0); // the ground is far
      }
    }
}

TEST_F(MetColliders, AreReadAndChecked) {
  const auto with = [&](const std::string& keys) {
    std::string sheet = read_file(folder_ / "sheet.json");
    sheet.insert(1, keys + ", ");
    write_file(folder_ / "other.json", sheet);
    SceneDescription description = read_scene(file_);
    description.garments[0].file = folder_ / "other.json";
    return load_scene(description).garments[0].met;
  };
  EXPECT_EQ(with(R"("ignore": ["Hips"])").names, std::vector<std::string>{"Hips"});
  EXPECT_EQ(with(R"("only": [])").which, Which::only);
  const auto message = [&](const std::string& keys) {
    try {
      with(keys);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using testing::AllOf;
  using testing::HasSubstr;
  EXPECT_THAT(
      message(R"("ignore": ["Hips", "LeftArmm"])"),
      AllOf(HasSubstr("other.json"), HasSubstr("/ignore/1"), HasSubstr("LeftArmm"), HasSubstr("a joint or a proxy")));
  EXPECT_THAT(message(R"("ignore": [], "only": [])"), AllOf(HasSubstr("/only"), HasSubstr("either ignore or only")));
  EXPECT_THAT(message(R"("ignore": "Hips")"), HasSubstr("/ignore"));
  EXPECT_THAT(message(R"("only": [3])"), HasSubstr("/only/0"));
}

} // namespace
