// One way to simulate a scene: what a chart has a point for, and how it changes the scene.
#pragma once

#include "src/scene/load.h"

#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// Setting::proxies when it is not a file.
inline constexpr const char *k_own_proxies = "scene", *k_no_proxies = "none";

struct Setting : RunSettings {
  std::string name;                    ///< for people ("default"); may be empty, and is no part of what the setting is
  double resolution = 1.0;             ///< times the scene's own cells along each side of its garments
  std::string proxies = k_own_proxies; ///< k_own_proxies, k_no_proxies, or a proxies file

  bool operator==(const Setting&) const = default;
};

/// A scene's own setting, named "default".
Setting own_setting(const RunSettings& of_scene);

/// Its values in words, in the order of setting_columns(): the columns of results, and what makes two settings one. The
/// seed is none of them: runs of a setting differ in it.
std::vector<std::string> setting_values(const Setting& setting);
const std::vector<std::string>& setting_columns();

using SettingValues = std::vector<std::string>;

/// What of it, being other than the scene's, no garment there would honour.
std::optional<Unhonoured> unhonoured(const Setting& setting, const Scene& scene);

/// What tells one setting from another, in words: "mass_spring, 5 substeps"; "" when nothing does.
std::string difference(const SettingValues& values, const SettingValues& others);

/// The options of `tutu cell` that give this setting where the scene's own is another: "--solver", "mass_spring",
/// "--no-swept".
std::vector<std::string> setting_options(const SettingValues& values, const SettingValues& of_scene);

/// The scene under that setting. Throws InputError as read_proxies and put_on.
LoadedScene with_setting(const LoadedScene& scene, const Setting& setting);

/// A start of the scene's own resolution for one of `resolution` times its cells: carried over, then eased for a second
/// in the first pose under the scene's own setting and much drag. Coarser cloth cannot lie in the same folds: its edges
/// begin pressed together, and would spring apart.
GarmentPositions start_at_resolution(const LoadedScene& scene, const GarmentPositions& start, double resolution);

} // namespace tutu::app
