// The standard scenes of stability and of formulas, run by name, as text and JSON.
#pragma once

#include "src/study/bench/analytic_scenes.h"
#include "src/study/bench/stability_run.h"

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tutu::app {

/// Names that report_stability knows, in the order of their families.
std::vector<std::string> stability_names();

struct StabilityReport {
  bool passed = false; ///< all of it
  std::string text;    ///< a line a variant or figure, and one for each thing that does not hold
  nlohmann::json json;
  RunEnd end; ///< of each variant of a scene of stability: the worst that any of its runs ended with
};

/// Runs the family of this name; stability scenes from `runs` uneven starts each. `go_on` is asked before each run;
/// what was not run has not passed.
StabilityReport report_stability(const std::string& name, const RunSettings& setup, int runs,
                                 const std::function<bool()>& go_on);

} // namespace tutu::app
