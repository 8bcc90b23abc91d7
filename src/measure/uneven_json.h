// What of a run's start is random, as JSON has it.
#pragma once

#include "src/run/settings.h"

#include <nlohmann/json.hpp>

namespace tutu::app {

/// "uneven_mm", and its "seed", which is null where nothing is random.
inline nlohmann::json uneven_json(const RunSettings& settings) {
  return {{"uneven_mm", settings.uneven_mm},
          {"seed", settings.uneven_mm > 0.0 ? nlohmann::json(settings.seed) : nlohmann::json(nullptr)}};
}

} // namespace tutu::app
