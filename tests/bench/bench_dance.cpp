// The default dance, a frame at a time, for each backend: posing, colliders, both garments, and the skin.
#include "src/run/session.h"
#include "src/scene/load.h"
#include "src/scene/saved_drape.h"

#include <benchmark/benchmark.h>

namespace {

using namespace tutu;

void dance(benchmark::State& state, proxies::Backend backend) {
  app::SceneDescription description =
      app::read_scene(std::filesystem::path(TUTU_SOURCE_DIR) / "assets/scenes/dance.json");
  description.settings.backend = backend;
  const app::LoadedScene scene = app::load_scene(description);
  bool stale = false;
  const auto start = app::saved_drape(scene, &stale);
  if (!start) return state.SkipWithError("no drape of the dance: run tutu drape");
  app::Session session(scene);
  session.start(*start);
  for (auto _ : state) {
    session.advance();
    session.skin_body();
    if (session.failure()) return state.SkipWithError(session.failure()->message().c_str());
  }
}

BENCHMARK_CAPTURE(dance, fcl, proxies::Backend::fcl)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(dance, brute, proxies::Backend::brute)->Unit(benchmark::kMillisecond);

} // namespace
