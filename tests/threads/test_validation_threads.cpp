// Frames measured side by side: the same figures as one after the other.
#include "src/measure/validation.h"
#include "src/scene/load.h"
#include "src/study/report/validation_json.h"
#include "tests/support/capsule_character.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

TEST(Validation, FramesSideBySideGiveTheSameFigures) {
  const auto folder = scratch_folder();
  const proxies::Capsule trunk{{0, 0.3, 0}, {0, 0.7, 0}, 0.12};
  CapsuleBody body;
  body.add(trunk, 32, 8, 6);
  write_capsule_character(folder / "body.dae", body, {0, 0.5, 0});
  write_file(folder / "turn.json", R"({"keys": [{"time": 0, "joints": {}},
    {"time": 0.2, "joints": {"Hips": {"rotation": [0, 0.5, 0, 0.8660254037844386]}}}]})");
  write_file(folder / "proxies.json", proxies_json({{trunk.a, trunk.b, 0.11}}));
  write_file(folder / "scene.json", R"({"character": "body.dae", "motion": "turn.json", "proxies": "proxies.json"})");
  const LoadedScene scene = load_scene(read_scene(folder / "scene.json"));
  ValidationOptions options;
  options.samples = 2000;
  const auto figures = [&](int threads) {
    options.threads = threads;
    Validation result = validate(scene, options, std::nullopt, [](int, int) { return true; });
    result.seconds = 0.0;
    return validation_json(result, scene, std::nullopt).dump();
  };
  const std::string one = figures(1);
  for (const int threads : {2, 4}) EXPECT_EQ(figures(threads), one) << threads << " threads";
  std::filesystem::remove_all(folder);
}

} // namespace
