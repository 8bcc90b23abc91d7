// What a plan found, for people and for machines.
#pragma once

#include "src/study/plan/plan_bench.h"

#include <nlohmann/json.hpp>

namespace tutu::app {

/// Everything that was measured on the way.
struct PlanRecord {
  std::vector<PlanChoice> choices;
  PlanResult result;
  std::map<PlanLevels, PlanErrors> tried;                             ///< of each model, when it was tried
  std::map<PlanLevels, PlanErrors> errors;                            ///< the worst seen of each model
  std::map<std::pair<PlanLevels, PlanLevels>, PlanBench::Pair> costs; ///< of the first against the second
  std::optional<PlanBench::Pair> cost;                                ///< of the plan against the scene's own
  std::vector<ProxyUse> proxies;                                      ///< of the set the plan is made from
  std::vector<std::string> kept;                                      ///< names of those that stay
  double skinning_ms = 0.0;
  bool skin_needed = false; ///< by the simulation itself: it collides with the true body, or cloth hangs on the skin
};

/// What the error is, in one sentence that names all limits.
std::string goal_text(const PlanGoal& goal, const PlanLimits& limits);

nlohmann::ordered_json errors_json(const PlanErrors& errors);

std::string plan_text(const std::string& scene, const PlanRecord& record, const PlanGoal& goal,
                      const PlanLimits& limits, std::optional<double> budget_ms);

nlohmann::ordered_json plan_json(const std::string& scene, const PlanRecord& record, const PlanGoal& goal,
                                 const PlanLimits& limits, std::optional<double> budget_ms);

} // namespace tutu::app
