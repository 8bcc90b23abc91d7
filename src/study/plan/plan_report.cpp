#include "src/study/plan/plan_report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

using nlohmann::ordered_json;

constexpr const char* k_what[] = {
    "the deepest that free cloth is inside of the true body over the motion",
    "how far cloth is off the reference in the first second, RMS",
    "how far the settled cloth is off the reference's shape, RMS",
    "the deepest that free cloth is inside of the true body over the motion; and the shape stays what it was",
};

/// What one choice came to.
struct Row {
  std::string name, was, is, reason;
  bool changed = false;
  std::optional<PlanErrors> errors;    ///< with the change
  std::optional<PlanBench::Pair> cost; ///< after against before the change
};

std::string cost_text(const PlanCost& cost) { return fmt::format("{:.3f} ({:.3f})", cost.median, cost.p99); }

/// Why this choice stands where it does: how it came there, and what was refused.
Row row_of(const PlanRecord& record, std::size_t axis, const PlanLimits& limits) {
  const PlanChoice& choice = record.choices[axis];
  const int level = record.result.levels[axis];
  Row row{choice.name, choice.values[choice.own].words, choice.values[level].words, "", level != choice.own, {}, {}};
  std::string came, refused;
  bool was_elsewhere = false;
  for (const PlanTrial& trial : record.result.trials) {
    const int from = trial.from[axis], to = trial.to[axis];
    const bool own_trial = trial.axis == static_cast<int>(axis);
    const PlanErrors& errors = record.tried.at(trial.to);
    if (trial.end == PlanTrial::End::kept && from != to) {
      was_elsewhere = true;
      if (to != level) continue;
      row.errors = errors;
      const PlanChoice& other = record.choices[static_cast<std::size_t>(trial.axis)];
      if (!own_trial) came = fmt::format("so that {} can be {}", other.name, other.values[trial.to[trial.axis]].words);
      else if (trial.cost_ratio) came = "good enough: " + worst_of(errors, limits);
      else
        came = fmt::format("needed; with {}: {}", choice.values[from].words,
                           worst_of(record.errors.at(trial.from), limits));
      const auto cost = record.costs.find({trial.to, trial.from});
      if (own_trial && cost != record.costs.end()) row.cost = cost->second;
    } else if (own_trial && trial.end == PlanTrial::End::not_good && to < from) {
      refused = choice.values[to].words + ": " + worst_of(errors, limits);
    } else if (own_trial && trial.end == PlanTrial::End::not_cheaper) {
      refused = fmt::format("{}: takes {:.2f} times the time", choice.values[to].words, *trial.cost_ratio);
    }
  }
  if (came.empty() && was_elsewhere) came = "taken back when the whole was verified";
  if (came.empty() && refused.empty()) came = choice.own == 0 ? "the cheapest already" : "not tried";
  row.reason = came + (came.empty() || refused.empty() ? "" : "; ") + refused;
  return row;
}

ordered_json cost_json(const PlanCost& cost) { return {{"median", cost.median}, {"p99", cost.p99}}; }

} // namespace

ordered_json errors_json(const PlanErrors& e) {
  ordered_json json = {{"body_mm", 1e3 * e.body},
                       {"trajectory_mm", 1e3 * e.trajectory},
                       {"drape_mm", 1e3 * e.drape},
                       {"longer_pct", {{"p99", 1e2 * e.longer_p99}, {"max", 1e2 * e.longer_max}}}};
  if (!e.trouble.empty()) json["trouble"] = e.trouble;
  return json;
}

namespace {

/// Metres in mm; JSON has no infinity.
ordered_json mm_json(std::optional<double> metres) {
  return metres && std::isfinite(*metres) ? ordered_json(1e3 * *metres) : ordered_json(nullptr);
}

bool is_kept(const PlanRecord& record, const std::string& name) {
  return std::find(record.kept.begin(), record.kept.end(), name) != record.kept.end();
}

std::string proxies_text(const PlanRecord& record) {
  if (record.proxies.empty()) return "";
  int beyond = 0, untouched = 0;
  for (const ProxyUse& use : record.proxies) {
    beyond += !use.in_reach;
    untouched += use.in_reach && !use.touched;
  }
  return fmt::format("proxies: {} of {} stay; {} can be met by no cloth in this motion, {} more were not touched\n",
                     record.kept.size(), record.proxies.size(), beyond, untouched);
}

std::string skinning_text(const PlanRecord& record) {
  return fmt::format("skinning: {}; the body's vertices take {:.3f} ms a frame, which is not in the times above\n",
                     record.skin_needed ? "needed by the simulation, of the parts that cloth hangs on or collides with"
                                        : "not needed but to draw her: cloth meets proxies and hangs on joints",
                     record.skinning_ms);
}

std::string verdict(const PlanRecord& record, const PlanLimits& limits, std::optional<double> budget_ms) {
  const PlanResult& result = record.result;
  const auto errors = record.errors.find(result.levels);
  const std::string worst = errors == record.errors.end() ? "nothing was measured" : worst_of(errors->second, limits);
  std::string text = result.good          ? "met: "
                     : result.interrupted ? "interrupted; the best so far, not verified: "
                                          : "NOT MET: the stated error cannot be met; the best that was found: ";
  text += worst + "\n";
  if (errors != record.errors.end())
    text += fmt::format("no thread in any frame is longer by more than {:.0f} %\n", 1e2 * errors->second.longer_max);
  if (budget_ms && !result.in_budget)
    text += fmt::format("NOT MET: nothing that was found takes {:g} ms a frame; this takes {:.3f}\n", *budget_ms,
                        result.ms);
  else if (budget_ms && !result.good && !result.interrupted)
    text += fmt::format("it is the best within {:g} ms a frame\n", *budget_ms);
  if (record.cost)
    text += fmt::format("ms a frame, median (p99): {} before, {} after: {:.2f} times\n", cost_text(record.cost->second),
                        cost_text(record.cost->first), record.cost->ratio);
  return text;
}

} // namespace

std::string goal_text(const PlanGoal& goal, const PlanLimits& limits) {
  std::string text =
      fmt::format("error \"{}\", at most {:g} mm: {}", k_plan_error_names[static_cast<std::size_t>(goal.error)],
                  1e3 * goal.most, k_what[static_cast<std::size_t>(goal.error)]);
  if (goal.error == PlanError::all)
    text += fmt::format(" (at most {:.1f} mm off the reference in the first second, {:.1f} mm off its settled shape: "
                        "the scene's own and so much more)",
                        1e3 * limits.trajectory.value_or(0.0), 1e3 * limits.drape.value_or(0.0));
  return text +
         fmt::format("; 99 % of the threads at most {:.1f} % longer; nothing diverges\n", 1e2 * limits.longer_p99);
}

std::string plan_text(const std::string& scene, const PlanRecord& record, const PlanGoal& goal,
                      const PlanLimits& limits, std::optional<double> budget_ms) {
  std::string text = scene + ": " + goal_text(goal, limits) + "\n";
  for (std::size_t axis = 0; axis < record.choices.size(); ++axis) {
    const Row row = row_of(record, axis, limits);
    text += fmt::format("{:<18}{}\n", row.name, row.changed ? row.was + " -> " + row.is : row.is + " (kept)");
    text += fmt::format("{:18}{}\n", "", row.reason);
    if (row.cost)
      text += fmt::format("{:18}ms a frame, median (p99): {} before, {} after\n", "", cost_text(row.cost->second),
                          cost_text(row.cost->first));
  }
  return text + "\n" + proxies_text(record) + skinning_text(record) + verdict(record, limits, budget_ms);
}

ordered_json plan_json(const std::string& scene, const PlanRecord& record, const PlanGoal& goal,
                       const PlanLimits& limits, std::optional<double> budget_ms) {
  const PlanResult& result = record.result;
  ordered_json json = {{"scene", scene},
                       {"error", k_plan_error_names[static_cast<std::size_t>(goal.error)]},
                       {"error_is", k_what[static_cast<std::size_t>(goal.error)]},
                       {"error_mm", 1e3 * goal.most}};
  json["limits"] = {{"body_mm", mm_json(limits.body)},
                    {"trajectory_mm", mm_json(limits.trajectory)},
                    {"drape_mm", mm_json(limits.drape)},
                    {"longer_pct", {{"p99", 1e2 * limits.longer_p99}}}};
  json["budget_ms"] = budget_ms ? ordered_json(*budget_ms) : ordered_json(nullptr);
  json["met"] = result.good;
  json["within_budget"] = result.in_budget;
  json["interrupted"] = result.interrupted;
  json["frames"] = goal.frames;
  json["starts"] = goal.starts;
  if (const auto errors = record.errors.find(result.levels); errors != record.errors.end())
    json["measured"] = errors_json(errors->second);
  if (record.cost) {
    json["ms"] = {{"before", cost_json(record.cost->second)}, {"after", cost_json(record.cost->first)}};
    json["cost_ratio"] = record.cost->ratio;
  }
  json["choices"] = ordered_json::array();
  for (std::size_t axis = 0; axis < record.choices.size(); ++axis) {
    const Row row = row_of(record, axis, limits);
    ordered_json one = {
        {"name", row.name}, {"was", row.was}, {"is", row.is}, {"changed", row.changed}, {"reason", row.reason}};
    if (row.errors) one["measured"] = errors_json(*row.errors);
    if (row.cost) one["ms"] = {{"before", cost_json(row.cost->second)}, {"after", cost_json(row.cost->first)}};
    json["choices"].push_back(std::move(one));
  }
  json["proxies"] = ordered_json::array();
  for (const ProxyUse& use : record.proxies)
    json["proxies"].push_back({{"name", use.name},
                               {"clearance_mm", mm_json(use.clearance)},
                               {"nearest_mm", mm_json(use.nearest)},
                               {"in_reach", use.in_reach},
                               {"touched", use.touched},
                               {"kept", is_kept(record, use.name)}});
  json["skinning"] = {{"needed", record.skin_needed}, {"ms", record.skinning_ms}};
  return json;
}

} // namespace tutu::app
