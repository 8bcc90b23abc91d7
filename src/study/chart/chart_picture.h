// Error against time as a picture, through gnuplot.
#pragma once

#include "src/study/chart/chart_points.h"

#include <filesystem>

namespace tutu::app {

/// One point a setting on logarithmic axes, the Pareto front as a line, named settings and the front's in words; failed
/// ones at the upper edge with the reason. Throws as write_chart (export/chart.h).
void write_chart_picture(const std::vector<ChartPoint>& points, const ErrorAxis& axis, const std::string& scene,
                         const std::filesystem::path& file);

} // namespace tutu::app
