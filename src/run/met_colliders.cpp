#include "src/run/met_colliders.h"

#include "rig/error.h"

#include <algorithm>

namespace tutu::app {
namespace {

/// The joint that carries most of both ends.
int joint_of(const proxies::Proxy& proxy) {
  std::vector<double> carried;
  for (const proxies::Anchor* end : {&proxy.a, &proxy.b})
    for (int k = 0; k < end->count; ++k) {
      carried.resize(std::max(carried.size(), static_cast<std::size_t>(end->joints[k]) + 1), 0.0);
      carried[end->joints[k]] += end->weights[k];
    }
  return static_cast<int>(std::max_element(carried.begin(), carried.end()) - carried.begin());
}

bool names(const std::vector<std::string>& some, const proxies::Proxy& proxy, const rig::Skeleton& skeleton) {
  const int carrier = joint_of(proxy);
  return std::ranges::any_of(
      some, [&](const std::string& name) { return name == proxy.name || skeleton.find(name) == carrier; });
}

} // namespace

std::vector<std::uint8_t> ignored_by(const cloth::Garment& garment, std::span<const proxies::Proxy> colliders,
                                     const rig::Skeleton& skeleton) {
  const auto& [which, some] = garment.met;
  if (which == cloth::MetColliders::Which::all) return {};
  std::vector<std::uint8_t> ignored;
  for (const proxies::Proxy& proxy : colliders)
    ignored.push_back(names(some, proxy, skeleton) == (which == cloth::MetColliders::Which::all_but));
  return ignored;
}

void check_met_colliders(const cloth::MetColliders& met, const std::string& file,
                         std::span<const proxies::Proxy> proxies, const rig::Skeleton& skeleton) {
  const char* key = met.which == cloth::MetColliders::Which::only ? "/only/" : "/ignore/";
  for (std::size_t k = 0; k < met.names.size(); ++k) {
    const std::string& name = met.names[k];
    const bool is_proxy = std::ranges::any_of(proxies, [&](const proxies::Proxy& p) { return p.name == name; });
    if (!is_proxy && !skeleton.find(name))
      throw InputError(file, key + std::to_string(k), '"' + name + '"', "a joint or a proxy of the character");
  }
}

} // namespace tutu::app
