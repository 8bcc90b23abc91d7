#include "src/study/plan/plan_model.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

using Value = PlanChoice::Value;

Value substeps_value(int substeps) {
  return {fmt::format("{} a frame", substeps), [=](PlanModel& m) { m.setting.substeps = substeps; }};
}
Value passes_value(int passes) {
  return {std::to_string(passes), [=](PlanModel& m) { m.setting.passes = passes; }};
}
Value margin_value(double mm) {
  return {mm == 0.0 ? "none" : fmt::format("{:g} mm", mm), [=](PlanModel& m) { m.margin = 1e-3 * mm; }};
}
Value resolution_value(double times) {
  return {times == 1.0 ? "the scene's" : fmt::format("{:g} x the cells a side", times),
          [=](PlanModel& m) { m.setting.resolution = times; }};
}
Value fitted_value(FittedSet set) {
  return {fmt::format("{} fitted {}", set.count, set.tapered ? "tapered capsules" : "capsules"),
          [=](PlanModel& m) { m.fitted = set; }};
}
Value features_value(cloth::ContactFeatures features) {
  return {std::string(cloth::k_contact_features_names[static_cast<std::size_t>(features)]),
          [=](PlanModel& m) { m.setting.features = features; }};
}
Value switch_value(bool Setting::*member, bool on) {
  return {on ? "on" : "off", [=](PlanModel& m) { m.setting.*member = on; }};
}

} // namespace

std::vector<PlanChoice> choices_of(const RunSettings& d, bool fits, bool regrids) {
  std::vector<PlanChoice> choices;
  if (fits) {
    PlanChoice margin{"proxy margin", {}, 0, true};
    for (const double mm : {0.0, 1.0, 2.0, 3.0}) margin.values.push_back(margin_value(mm));
    choices.push_back(std::move(margin));
  }
  PlanChoice passes{"passes", {}, d.passes - 1, true}; // cheaper than as many substeps
  for (int n = 1; n <= std::max(3, d.passes); ++n) passes.values.push_back(passes_value(n));
  if (d.solver == cloth::SolverKind::xpbd) choices.push_back(std::move(passes));
  // Nobody looks whether a scene needs more of what it does without: where it is off, there is no choice.
  const auto off_if_on = [&](const char* name, bool Setting::*member, bool on) {
    if (on) choices.push_back({name, {switch_value(member, false), switch_value(member, true)}, 1});
  };
  off_if_on("self-collision", &Setting::self_collision, d.self_collision);
  if (d.solver != cloth::SolverKind::xpbd)
    choices.push_back({"solver",
                       {{"xpbd", [](PlanModel& m) { m.setting.solver = cloth::SolverKind::xpbd; }},
                        {std::string(cloth::name_of(d.solver)), [](PlanModel&) {}}},
                       1});
  if (d.backend != proxies::Backend::hybrid)
    choices.push_back(
        {"backend",
         {{"hybrid", [](PlanModel& m) { m.setting.backend = proxies::Backend::hybrid; }},
          {std::string(proxies::k_backend_names[static_cast<std::size_t>(d.backend)]), [](PlanModel&) {}}},
         1});
  off_if_on("double precision", &Setting::double_precision, d.double_precision);
  if (fits) {
    const auto kept = [](const char* words, ProxiesKept which) {
      return Value{words, [=](PlanModel& m) { m.kept = which; }};
    };
    // What no cloth can reach is left out of every model: that needs no measuring.
    choices.push_back({"proxies kept",
                       {kept("those that cloth came near to", ProxiesKept::touched),
                        kept("those in reach of cloth", ProxiesKept::in_reach)},
                       1,
                       false,
                       true});
  }

  PlanChoice substeps{"substeps", {}, d.substeps - 1};
  for (int n = 1; n <= d.substeps; ++n) substeps.values.push_back(substeps_value(n));
  for (const double times : {1.5, 2.0})
    substeps.values.push_back(substeps_value(static_cast<int>(std::ceil(times * d.substeps)) + (times > 1.5)));
  choices.push_back(std::move(substeps));

  PlanChoice features{"contact features", {}, 0};
  for (const auto f :
       {cloth::ContactFeatures::particles, cloth::ContactFeatures::automatic, cloth::ContactFeatures::triangles}) {
    if (f == d.features) features.own = static_cast<int>(features.values.size());
    features.values.push_back(features_value(f));
  }
  choices.push_back(std::move(features));
  if (regrids) {
    PlanChoice grid{"grid", {}, 0};
    for (const double times : {0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.5, 2.0}) {
      if (times == 1.0) grid.own = static_cast<int>(grid.values.size());
      grid.values.push_back(resolution_value(times));
    }
    choices.push_back(std::move(grid));
  }
  if (fits) {
    PlanChoice set{"proxy set", {}, 0};
    for (const int count : {12, 18, 24})
      for (const bool tapered : {false, true}) set.values.push_back(fitted_value({count, tapered}));
    set.own = static_cast<int>(set.values.size());
    set.values.push_back({"the scene's", [](PlanModel&) {}});
    set.values.push_back(fitted_value({48, true}));
    choices.push_back(std::move(set));
  }
  off_if_on("swept contacts", &Setting::swept, d.swept);
  off_if_on("adaptive substeps", &Setting::adaptive_substeps, d.adaptive_substeps);
  return choices;
}

PlanModel model_of(const RunSettings& scene, const std::vector<PlanChoice>& choices, const PlanLevels& levels) {
  PlanModel model;
  model.setting = own_setting(scene);
  model.setting.name.clear();
  for (std::size_t k = 0; k < choices.size(); ++k) choices[k].values[levels[k]].apply(model);
  return model;
}

} // namespace tutu::app
