// The chart as one HTML page: no network, no other file.
#pragma once

#include "src/study/chart/chart_points.h"
#include "src/study/chart/reference.h"

#include <string>
#include <vector>

namespace tutu::app {

/// Charts on any of the errors, a table that sorts by any column, and for a clicked point its figures and the command
/// line that measures it again. `scene_words`: arguments of `tutu cell` that name scene and protocol.
std::string chart_page(const std::vector<ChartPoint>& points, const Reference& reference, const std::string& verdict,
                       const std::vector<std::string>& scene_words, const SettingValues& default_setting);

} // namespace tutu::app
