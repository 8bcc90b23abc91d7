// What `tutu cell` and `tutu chart` have in common: the scene, how long a run is, and the reference.
#pragma once

#include "src/scene/load.h"
#include "src/study/chart/reference.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

struct ChartOptions {
  std::string scene; ///< empty: the default scene
  bool quick = false;
  std::optional<int> frames, settle, held, every;
  std::vector<int> reference_substeps;
  std::optional<double> reference_resolution;
  std::string cache, reference;

  void add_to(CLI::App& command);

  std::filesystem::path scene_file() const;
  /// The scene without changes; notes of the loading go to stderr.
  LoadedScene load() const;
  /// Of the scene: the whole motion, or with --quick its first seconds, unless options say otherwise.
  ReferencePlan plan(const LoadedScene& loaded) const;
  /// The file that --reference names, or of the cache, or made now. Nothing when interrupted; that has been printed.
  std::optional<Reference> obtain(const LoadedScene& loaded, int jobs) const;
  /// These options again, for another process.
  std::vector<std::string> words() const;
};

} // namespace tutu::app
