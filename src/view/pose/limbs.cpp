#include "src/view/pose/limbs.h"

#include "rig/body_regions.h"
#include "rig/strong_poses.h"

#include <algorithm>

namespace tutu::app {

std::vector<BodyLimb> find_limbs(const rig::Skeleton& skeleton) {
  using rig::BodyRegion;
  const std::vector<BodyRegion> regions = rig::body_regions(skeleton);
  std::vector<BodyLimb> limbs;
  for (int end = 0; end < skeleton.joint_count(); ++end) {
    const int above = skeleton.parents[end];
    if (above == rig::k_no_parent) continue;
    const bool hand = regions[end] == BodyRegion::hands && regions[above] == BodyRegion::arms;
    const bool foot = regions[end] == BodyRegion::feet && regions[above] == BodyRegion::legs;
    if (!hand && !foot) continue;
    std::vector<int> joints; // of the limb, from the lowest up
    std::vector<double> way; // m from the end
    double length = skeleton.rest_local[end].translation.norm();
    const auto belongs = [&](int j) {
      if (regions[j] == regions[above]) return true;
      // A hip that is called so is torso, and yet bends the leg: where it has the limb's side.
      return joints.size() == 1 && rig::side_of(skeleton.names[j]) != rig::Side::middle &&
             rig::side_of(skeleton.names[j]) == rig::side_of(skeleton.names[end]);
    };
    for (int j = above; j != rig::k_no_parent && belongs(j); j = skeleton.parents[j]) {
      joints.push_back(j);
      way.push_back(length);
      length += skeleton.rest_local[j].translation.norm();
    }
    if (joints.size() < 2) continue;
    const double half = 0.5 * way.back();
    std::size_t middle = 0;
    for (std::size_t i = 0; i + 1 < joints.size(); ++i)
      if (std::abs(way[i] - half) < std::abs(way[middle] - half)) middle = i;
    limbs.push_back({{joints.back(), joints[middle], end, std::nullopt}, foot});
  }
  return limbs;
}

std::optional<BodyLimb> limb_ending_at(std::span<const BodyLimb> limbs, int joint) {
  for (const BodyLimb& limb : limbs)
    if (limb.limb.end == joint) return limb;
  return std::nullopt;
}

std::optional<BodyLimb> limb_bending_at(std::span<const BodyLimb> limbs, int joint) {
  for (const BodyLimb& limb : limbs)
    if (limb.limb.lower == joint) return limb;
  return std::nullopt;
}

Vec3 pole_of(const rig::Skeleton& skeleton, std::span<const Transform> local, const BodyLimb& limb) {
  constexpr double k_bent = 0.02; // of the limb's length: less is straight to a hand
  const Vec3 a = rig::model_of_joint(skeleton, local, limb.limb.upper).translation;
  const Vec3 b = rig::model_of_joint(skeleton, local, limb.limb.lower).translation;
  const Vec3 c = rig::model_of_joint(skeleton, local, limb.limb.end).translation;
  const double length = (b - a).norm() + (c - b).norm();
  const Vec3 along = (c - a).norm() > 0.0 ? Vec3((c - a).normalized()) : Vec3((b - a).normalized());
  const Vec3 side = (b - a) - (b - a).dot(along) * along;
  if (side.norm() > k_bent * length) return b + length * side.normalized();
  const int body = skeleton.parents[limb.limb.upper];
  Quat turn = Quat::Identity();
  if (body != rig::k_no_parent)
    turn = rig::model_of_joint(skeleton, local, body).rotation *
           rig::model_of_joint(skeleton, skeleton.rest_local, body).rotation.conjugate();
  return b + length * (turn * Vec3(0.0, 0.0, limb.leg ? 1.0 : -1.0));
}

std::vector<int> chain_ending_at(const rig::Skeleton& skeleton, int joint) {
  constexpr std::size_t k_most_above = 5;
  std::vector<int> chain = {joint};
  for (int j = skeleton.parents[joint];
       j != rig::k_no_parent && skeleton.parents[j] != rig::k_no_parent && chain.size() <= k_most_above;
       j = skeleton.parents[j])
    chain.push_back(j);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

} // namespace tutu::app
