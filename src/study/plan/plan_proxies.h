// The proxies of a planned model: fitted to the motion where it says so, and only those that matter to its cloth.
#pragma once

#include "src/measure/cell_run.h"
#include "src/study/plan/plan_model.h"

#include <functional>
#include <map>

namespace tutu::app {

/// What is known of one proxy of a set.
struct ProxyUse {
  std::string name;
  std::optional<double> clearance; ///< m: no cloth can come nearer (garment_reach.h); nothing: cloth may be anywhere
  double nearest = 0.0;            ///< m: how near cloth came in the scene's own runs; infinity out of reach
  bool in_reach = true, touched = true;
};

/// Makes each set once. The scene must outlive it.
class PlanProxies {
public:
  /// `runs`: of the scene's own model, recorded in each frame.
  PlanProxies(const Scene& scene, const std::vector<Trajectory>& runs);

  /// The proxies of a model. Where `go_on` stops a fit it is the best so far. Throws InputError for a body that cannot
  /// be fitted.
  std::vector<proxies::Proxy> of(const PlanModel& model, const std::function<bool()>& go_on);

  /// Of the set that the model is made from, in its order.
  const std::vector<ProxyUse>& uses(const PlanModel& model) const { return sets_.at(model.fitted).uses; }

private:
  struct Set {
    std::vector<proxies::Proxy> proxies;
    std::vector<ProxyUse> uses;
  };

  std::vector<proxies::Proxy> fit(FittedSet set, const std::function<bool()>& go_on) const;
  std::vector<ProxyUse> uses_of(const std::vector<proxies::Proxy>& proxies) const;
  double nearest_cloth(const proxies::Proxy& proxy) const;

  const Scene* scene_;
  const std::vector<Trajectory>* runs_;
  std::vector<std::vector<Transform>> poses_; ///< model_from_joint, of each frame from the start on
  std::map<std::optional<FittedSet>, Set> sets_;
};

} // namespace tutu::app
