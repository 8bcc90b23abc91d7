// Maps of stability as files and text.
#pragma once

#include "src/study/report/cell_chart.h"
#include "src/study/stability/maps.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace tutu::app {

/// One line a cell of every map, with a head line: map, both axes in their units, starts, and how many ended how.
std::string maps_csv(const std::vector<StabilityMap>& maps);

/// All maps with their axes, cells, the scene's own place and its margin.
nlohmann::json maps_json(const std::vector<StabilityMap>& maps, const Scene& scene, const SceneSetting& setting,
                         const MapOptions& options);

/// A line a map: its name and the scene's margin in words. Maps of other methods are marked as such.
std::string maps_text(const std::vector<StabilityMap>& maps, const Scene& scene, const SceneSetting& setting);

/// Colours that every kind of colour vision tells apart, and letters besides [Okabe and Ito 2002].
CellChart chart_of(const StabilityMap& map, const SceneSetting& setting);

} // namespace tutu::app
