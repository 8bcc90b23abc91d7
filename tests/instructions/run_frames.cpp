// The frames whose instructions are counted (instructions.py): one thread, and kernels on one target of the processor,
// so that a run does the same work on any machine.
//
//   run_frames            the build and the names of its scenes, as JSON
//   run_frames SCENE      runs that one; frames, milliseconds a frame and the hash of its end, as JSON
//
// Status 1 where a run could not be carried, 2 for another command line, 77 where the processor lacks the target.
#include "cloth/metrics.h"
#include "rig/error.h"
#include "src/base/stopwatch.h"
#include "src/run/session.h"
#include "src/scene/load.h"
#include "src/scene/saved_drape.h"
#include "src/study/bench/dancer_skirt.h"
#include "tests/instructions/counted_frames.h"
#include "tests/support/simd_targets.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <gnu/libc-version.h>
#include <nlohmann/json.hpp>
#include <stdexcept>

using namespace tutu;

namespace {

using nlohmann::json;

constexpr int k_skipped = 77;
constexpr int k_dance_frames = 60;
/// Of dancer-skirt: those that set it in motion, then those that are counted. A third of a second each: under
/// valgrind, whose cost is in all of them, a frame takes some hundred times as long.
constexpr int k_started_frames = 20, k_skirt_frames = 20;

/// What valgrind 3.19 knows best; AVX-512 it does not.
constexpr std::int64_t k_target = HWY_AVX2;

json counted(const std::function<void()>& frame, int frames) {
  app::Stopwatch watch;
  tutu_counted_frames(frame, frames);
  return {{"frames", frames}, {"ms", watch.lap() / frames}};
}

std::string hexadecimal(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

json run_dancer_skirt(int n) {
  app::DancerSkirtSetup setup;
  setup.n = n;
  setup.substeps = app::default_substeps(setup.solver, n);
  app::DancerSkirt scene(setup);
  const auto frame = [&] {
    if (const auto divergence = scene.advance()) throw std::runtime_error("the skirt diverged");
  };
  for (int k = 0; k < k_started_frames; ++k) frame();
  json result = counted(frame, k_skirt_frames);
  result["hash"] = hexadecimal(cloth::state_hash(scene.particles()));
  return result;
}

/// A whole frame from the saved drape on: pose, colliders, both garments, the skin.
json run_dance() {
  app::SceneDescription description =
      app::read_scene(std::filesystem::path(TUTU_SOURCE_DIR) / "assets/scenes/dance.json");
  description.settings.threads = 1;
  const app::LoadedScene scene = app::load_scene(description);
  bool stale = false;
  const auto start = app::saved_drape(scene, &stale);
  if (!start) throw std::runtime_error("no drape of the dance that fits: tutu drape assets/scenes/dance.json");
  app::Session session(scene);
  session.start(*start);
  const auto frame = [&] {
    session.advance();
    session.skin_body();
    if (session.failure()) throw std::runtime_error(session.failure()->message());
  };
  json result = counted(frame, k_dance_frames);
  result["hash"] = hexadecimal(session.state_hash());
  return result;
}

struct CountedScene {
  const char* name;
  std::function<json()> run;
};
const CountedScene k_scenes[] = {{"dancer-skirt-30", [] { return run_dancer_skirt(30); }},
                                 {"dancer-skirt-64", [] { return run_dancer_skirt(64); }},
                                 {"dancer-skirt-128", [] { return run_dancer_skirt(128); }},
                                 {"dance", run_dance}};

/// All that changes a figure without a change of the sources.
json build() {
  json names = json::array();
  for (const CountedScene& scene : k_scenes) names.push_back(scene.name);
  return {{"scenes", names},
          {"build",
           {{"compiler", TUTU_COMPILER},
            {"type", TUTU_BUILD_TYPE},
            {"flags", TUTU_FLAGS},
            {"target", hwy::TargetName(k_target)},
            {"libraries", fmt::format("glibc {}, {}", ::gnu_get_libc_version(), TUTU_LIBRARIES)}}}};
}

} // namespace

int main(int count, char** arguments) try {
  if (count == 1) {
    fmt::print("{}\n", build().dump());
    return 0;
  }
  const auto* scene =
      std::ranges::find_if(k_scenes, [&](const CountedScene& s) { return s.name == std::string_view(arguments[1]); });
  if (count != 2 || scene == std::end(k_scenes)) {
    fmt::print(stderr, "run_frames: one scene of those that it tells of without any\n");
    return 2;
  }
  if (const auto all = test::simd_targets(); std::ranges::find(all, k_target) == all.end()) {
    fmt::print(stderr, "run_frames: no {} on this processor, or valgrind does not know it\n",
               hwy::TargetName(k_target));
    return k_skipped;
  }
  const test::OnTarget target(k_target);
  fmt::print("{}\n", scene->run().dump());
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "run_frames: {}\n", error.what());
  return 1;
}
