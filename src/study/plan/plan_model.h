// What a plan can choose: the axes of a scene, and the model that levels on them stand for.
#pragma once

#include "src/study/chart/setting.h"
#include "src/study/plan/plan_search.h"

#include <functional>
#include <string>
#include <vector>

namespace tutu::app {

/// Proxies that fit themselves to the scene's motion, in place of its own.
struct FittedSet {
  int count = 0;
  bool tapered = false;

  auto operator<=>(const FittedSet&) const = default;
};

/// Which proxies of a set stay.
enum class ProxiesKept {
  all,      ///< the scene as it is
  in_reach, ///< that any cloth can meet in the motion (garment_reach.h)
  touched   ///< and that cloth came within touching distance of in the scene's own run
};

struct PlanModel {
  Setting setting;
  std::optional<FittedSet> fitted; ///< none: the scene's own
  ProxiesKept kept = ProxiesKept::all;
  double margin = 0.0; ///< m, added to the radius of every proxy
};

/// One kind of choice; values from the cheapest to the most exact.
struct PlanChoice {
  struct Value {
    std::string words;
    std::function<void(PlanModel&)> apply;
  };
  std::string name;
  std::vector<Value> values;
  int own = 0;                        ///< the scene's
  bool helps = false, counts = false; ///< PlanAxis

  PlanAxis axis() const { return {static_cast<int>(values.size()), own, helps, counts}; }
};

/// What is left to choose in this scene, the greatest expected saving first. `fits`: its proxies can be fitted anew;
/// `regrids`: its garments can have other cells.
std::vector<PlanChoice> choices_of(const RunSettings& scene, bool fits, bool regrids);

PlanModel model_of(const RunSettings& scene, const std::vector<PlanChoice>& choices, const PlanLevels& levels);

} // namespace tutu::app
