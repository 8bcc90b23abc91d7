// What the commands that run a scene have in common: naming it, changing its settings, and starting it draped.
#pragma once

#include "src/scene/load.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::app {

/// For options with a real value: CLI11 reads "nan" and lets it through every range.
CLI::Validator finite_number();

/// One of these names.
CLI::Validator one_of(std::span<const std::string_view> names);

/// Options that change a scene's own settings.
struct SceneOptions {
  std::string scene; ///< empty: the default scene
  std::vector<SettingChange> changes;

  void add_to(CLI::App& command);
  /// The scene file with these options applied; notes of the loading go to stderr.
  LoadedScene load() const;
  std::optional<int> threads() const; ///< where they are among the changes
};

/// The draped start of a scene: its saved drape where that fits, else garments settled now (with a progress bar; the
/// file is left alone). Nothing when the drape diverged or was interrupted; the reason has been printed.
std::optional<GarmentPositions> draped_start(const LoadedScene& scene);

} // namespace tutu::app
