// Which settings a chart is made of: a grid that a person writes, or the built-in one.
#pragma once

#include "src/study/chart/setting.h"

#include <filesystem>
#include <vector>

namespace tutu::app {

/// Reads
///   { "settings": [ { "solver": "xpbd", "substeps": [4, 8, 12], "features": ["auto", "particles"] },
///                   { "name": "hand", "proxies": "dancer-hand.json" } ] }
/// Each object is a grid: every combination of what stands in its lists. Keys are setting_columns(); what is left out
/// is the scene's. A proxies file is named from the settings file's folder; a number stands for that many fitted
/// proxies (fitted_proxies()). The scene's own setting comes first, whether the file names it or not; none is there
/// twice. Throws InputError with file, place, found and expected, on an empty grid too.
std::vector<Setting> read_settings(const std::filesystem::path& file, const RunSettings& scene);

inline constexpr int k_report_rate = 40; ///< frames a second: of 5 substeps of 5 ms each

/// The setting of the report: mass_spring, 5 substeps of 5 ms, `proxies` placed by hand. Where the scene's rate has
/// fractions, k_report_rate is to the report's what the scene's is to its own nearest whole one.
Setting report_setting(const RunSettings& scene, const std::string& proxies);

/// What is built in: solvers, substeps, backends, features, grid sizes and proxies around the scene's own setting,
/// which comes first. The report's is there where a file NAME-hand.json lies beside the scene's proxies NAME.json.
std::vector<Setting> builtin_settings(const SceneDescription& scene, bool quick);

/// Setting::proxies of so many fitted ones, until they are made; and how many that are.
std::string fitted_proxies(int count);
std::optional<int> fitted_count(const Setting& setting);

} // namespace tutu::app
