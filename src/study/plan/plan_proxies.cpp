#include "src/study/plan/plan_proxies.h"

#include "proxies/distance/feature_contact.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/fit/fit.h"
#include "rig/error.h"
#include "src/run/garment_reach.h"
#include "src/run/posed_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tutu::app {
namespace {

constexpr std::size_t k_fitted_poses = 240; // given to a fit, which takes the most different of them
constexpr double k_under_weight = 12.0; // skin outside of proxies pokes through cloth; proxies outside of skin do not

proxies::Capsule placed(const proxies::Proxy& proxy, std::span<const Transform> pose) {
  return {proxy.a.place(pose), proxy.b.place(pose), proxy.radius, proxy.taper};
}

/// Distance of cloth from a capsule where that is less than `least`, else `least`.
double least_distance(const cloth::Garment& garment, std::span<const Vec3> positions, const proxies::Capsule& capsule,
                      double least) {
  for (const auto& triangle : garment.triangles) {
    const Vec3 &p = positions[triangle[0]], &q = positions[triangle[1]], &r = positions[triangle[2]];
    const Vec3 centroid = (p + q + r) / 3.0;
    const double radius = std::max({(p - centroid).norm(), (q - centroid).norm(), (r - centroid).norm()});
    if (proxies::signed_distance(centroid, capsule).distance - radius >= least) continue; // distances are 1-Lipschitz
    least = std::min(least, proxies::triangle_contact(p, q, r, capsule, Vec3::Zero()).distance);
  }
  return least;
}

} // namespace

PlanProxies::PlanProxies(const Scene& scene, const std::vector<Trajectory>& runs) : scene_(&scene), runs_(&runs) {
  const int frames = frames_of(scene);
  std::vector<Transform> local(scene.character.skeleton.rest_local);
  for (int f = 0; f <= frames; ++f) {
    rig::pose_at(scene.motion, scene.character.skeleton, f / double(scene.settings.frames_per_second), local,
                 poses_.emplace_back(local.size()));
  }
}

std::vector<proxies::Proxy> PlanProxies::of(const PlanModel& model, const std::function<bool()>& go_on) {
  auto found = sets_.find(model.fitted);
  if (found == sets_.end()) {
    Set set;
    set.proxies = model.fitted ? fit(*model.fitted, go_on) : scene_->proxies;
    std::erase_if(set.proxies, [](const proxies::Proxy& proxy) { return !proxy.enabled; });
    set.uses = uses_of(set.proxies);
    found = sets_.emplace(model.fitted, std::move(set)).first;
  }
  std::vector<proxies::Proxy> kept;
  for (std::size_t p = 0; p < found->second.proxies.size(); ++p) {
    const ProxyUse& use = found->second.uses[p];
    const bool stays = model.kept == ProxiesKept::all || (model.kept == ProxiesKept::in_reach && use.in_reach) ||
                       (model.kept == ProxiesKept::touched && use.touched);
    if (!stays) continue;
    kept.push_back(found->second.proxies[p]);
    kept.back().radius += model.margin;
  }
  return kept;
}

std::vector<proxies::Proxy> PlanProxies::fit(FittedSet set, const std::function<bool()>& go_on) const {
  proxies::FitOptions options;
  options.count = set.count;
  options.tapered = set.tapered;
  options.under_weight = k_under_weight;
  options.region = proxies::FitRegion::body;
  std::vector<std::vector<Transform>> poses;
  const std::size_t count = std::min(k_fitted_poses, poses_.size());
  for (std::size_t i = 0; i < count; ++i) poses.push_back(poses_[i * poses_.size() / count]);
  try {
    return proxies::fit_proxies(scene_->character, poses, options, [&](double) { return go_on(); }).proxies;
  } catch (const std::invalid_argument& problem) {
    throw InputError(scene_->character.file, "", problem.what(), "a character that can be fitted");
  }
}

std::vector<ProxyUse> PlanProxies::uses_of(const std::vector<proxies::Proxy>& proxies) const {
  const auto clearance =
      garment_clearance(scene_->character, scene_->garments, scene_->attachment_joints, poses_, proxies);
  double touching = 0.0;
  for (const cloth::Garment& garment : scene_->garments) touching = std::max(touching, touching_distance(garment));
  std::vector<ProxyUse> uses;
  for (std::size_t p = 0; p < proxies.size(); ++p) {
    ProxyUse& use = uses.emplace_back();
    use.name = proxies[p].name;
    use.clearance = clearance[p];
    // Contact keeps cloth off by its touching distance: within that it is met.
    use.in_reach = !clearance[p] || *clearance[p] <= touching;
    use.nearest = use.in_reach ? nearest_cloth(proxies[p]) : std::numeric_limits<double>::infinity();
    use.touched = use.in_reach && use.nearest <= touching;
  }
  return uses;
}

double PlanProxies::nearest_cloth(const proxies::Proxy& proxy) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Trajectory& run : *runs_)
    for (const Trajectory::Moment& moment : run.moments) {
      const auto frame = static_cast<std::size_t>(std::llround(moment.time * scene_->settings.frames_per_second));
      const proxies::Capsule capsule = placed(proxy, poses_[std::min(frame, poses_.size() - 1)]);
      for (std::size_t g = 0; g < moment.positions.size(); ++g)
        least = least_distance(scene_->garments[g], moment.positions[g], capsule, least);
    }
  return least;
}

} // namespace tutu::app
