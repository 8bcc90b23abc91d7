#include "src/options/scene_options.h"

#include "src/base/interrupt.h"
#include "src/base/progress.h"
#include "src/run/drape.h"
#include "src/scene/load.h"
#include "src/scene/saved_drape.h"

#include <cmath>
#include <fmt/format.h>

namespace tutu::app {

CLI::Validator finite_number() {
  return {[](std::string& text) {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
            return good ? std::string() : "found " + text + ", expected a finite number";
          },
          "FINITE"};
}

CLI::Validator one_of(std::span<const std::string_view> names) {
  return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
}

void SceneOptions::add_to(CLI::App& command) {
  command.add_option("scene", scene, "Scene file (.json); the shipped dance when left out");
  command.add_option("--substeps", substeps, "Substeps a frame, in place of the scene's")->check(CLI::Range(1, 10000));
  command.add_option("--threads", threads, "Threads that step garments side by side, in place of the scene's")
      ->check(CLI::Range(1, k_most_threads));
  command.add_option("--solver", solver, "How cloth is solved, in place of the scene's")
      ->check(one_of(cloth::k_solver_names));
  command.add_option("--backend", backend, "How particles ask colliders, in place of the scene's")
      ->check(one_of(proxies::k_backend_names));
  command.add_flag("--self-collision", self_collision, "Each garment collides with itself too (solver xpbd)");
}

LoadedScene SceneOptions::load() const {
  const std::filesystem::path file =
      scene.empty() ? assets_folder() / "scenes" / "dance.json" : std::filesystem::path(scene);
  SceneDescription description = read_scene(file);
  if (substeps) description.settings.substeps = *substeps;
  if (threads) description.settings.threads = *threads;
  if (solver) description.settings.solver = cloth::solver_named(*solver);
  if (backend) description.settings.backend = proxies::backend_named(*backend);
  description.settings.self_collision = description.settings.self_collision || self_collision;
  LoadedScene loaded = load_scene(description);
  for (const std::string& note : loaded.notes) fmt::print(stderr, "note: {}\n", note);
  return loaded;
}

std::optional<GarmentPositions> draped_start(const LoadedScene& scene) {
  bool stale = false;
  if (auto saved = saved_drape(scene, &stale)) return saved;
  if (stale)
    fmt::print(stderr, "note: {} was made for another state of the scene; draping anew (tutu drape saves it)\n",
               scene.files.drape.string());
  constexpr double k_longest = 4.0; // s: a start, not the last wrinkle
  Progress bar("draping", static_cast<int>(k_longest * scene.settings.frames_per_second));
  const DrapeResult result = drape(
      scene, k_longest,
      [&](int done, int) {
        bar.tick(done);
        return !interrupted();
      },
      &interrupt_flag());
  bar.finish();
  if (result.failure) {
    fmt::print(stderr, "tutu: while draping, {}\n", result.failure->message());
    return std::nullopt;
  }
  if (interrupted()) {
    fmt::print(stderr, "tutu: interrupted while draping\n");
    return std::nullopt;
  }
  return result.positions;
}

} // namespace tutu::app
