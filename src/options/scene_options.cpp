#include "src/options/scene_options.h"

#include "src/base/interrupt.h"
#include "src/base/progress.h"
#include "src/options/setting_options.h"
#include "src/run/drape.h"
#include "src/scene/load.h"
#include "src/scene/saved_drape.h"

#include <algorithm>
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
  add_setting_options(command, changes);
}

LoadedScene SceneOptions::load() const {
  const std::filesystem::path file =
      scene.empty() ? assets_folder() / "scenes" / "dance.json" : std::filesystem::path(scene);
  SceneDescription description = read_scene(file);
  description.changes = changes;
  LoadedScene loaded = load_scene(description);
  for (const std::string& note : loaded.notes) fmt::print(stderr, "note: {}\n", note);
  if (loaded.collides_with_body())
    if (const auto note = proxies::note_of(body_of(loaded.character).census()))
      fmt::print(stderr, "note: {}: {}\n", loaded.files.character.filename().string(), *note);
  return loaded;
}

std::optional<int> SceneOptions::threads() const {
  const SettingRow* const row = find_setting("threads");
  const auto found = std::find_if(changes.begin(), changes.end(), [&](const SettingChange& c) { return c.row == row; });
  return found == changes.end() ? std::nullopt : std::optional(found->value);
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
