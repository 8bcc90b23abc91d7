// A validation as one page for people: no network, no script, readable on a phone.
#pragma once

#include "src/measure/heat_map.h"
#include "src/scene/load.h"
#include "src/study/report/validation_json.h"

#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// The whole file. `maps`: of the worst frames, embedded; without any, `no_maps` says why.
std::string validation_html(const Validation& validation, const LoadedScene& scene,
                            const std::optional<Verdict>& verdict, const std::vector<HeatMap>& maps,
                            const std::string& no_maps);

} // namespace tutu::app
