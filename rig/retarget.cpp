#include "rig/clip.h"
#include "rig/error.h"
#include "rig/flight.h"

namespace tutu::rig {
namespace {

constexpr int k_unpaired = -1;

/// Of each target joint the source joint of that name. A pair is mutual: each is the one the other's name finds.
std::vector<int> paired_sources(const Skeleton& source, const Skeleton& target) {
  std::vector<int> partner(target.joint_count(), k_unpaired);
  for (int t = 0; t < target.joint_count(); ++t) {
    const std::optional<int> s = source.find(target.names[t]);
    if (s && target.find(source.names[*s]) == t) partner[t] = *s;
  }
  return partner;
}

/// Of each target joint the nearest paired joint above it.
std::vector<int> paired_parents(const Skeleton& target, const std::vector<int>& partner) {
  std::vector<int> above(target.joint_count(), k_no_parent);
  for (int t = 0; t < target.joint_count(); ++t) {
    const int parent = target.parents[t];
    if (parent != k_no_parent) above[t] = partner[parent] != k_unpaired ? parent : above[parent];
  }
  return above;
}

/// Of each target joint the turn (model space) that points its rest bone as the source's rest bone.
///
/// A bone is the way to the one paired joint below. Where the pairs branch (hips, chest, hand) or end (fingertip) there
/// is no one bone: such a joint follows the paired joint above it, so that a hand stays in line with its turned
/// forearm; the topmost joint stands as it is.
std::vector<Quat> alignments(const std::vector<int>& partner, const std::vector<int>& above,
                             const std::vector<Transform>& source_rest, const std::vector<Transform>& target_rest) {
  constexpr int k_none = -1, k_several = -2;
  std::vector<int> below(partner.size(), k_none);
  for (std::size_t t = 0; t < partner.size(); ++t) {
    if (partner[t] == k_unpaired || above[t] == k_no_parent) continue;
    int& only = below[above[t]];
    only = only == k_none ? static_cast<int>(t) : k_several;
  }
  std::vector<Quat> turns(partner.size(), Quat::Identity());
  for (std::size_t t = 0; t < partner.size(); ++t) {
    if (partner[t] == k_unpaired) continue;
    if (below[t] >= 0)
      turns[t] = rotation_between(target_rest[below[t]].translation - target_rest[t].translation,
                                  source_rest[partner[below[t]]].translation - source_rest[partner[t]].translation);
    else if (above[t] != k_no_parent) turns[t] = turns[above[t]];
  }
  return turns;
}

/// How many times farther than the source's the target's joint travels: as its rest height to the source's.
double travel_ratio(double source_height, double target_height) {
  constexpr double k_least_height = 1e-3; // m; a joint on the ground says nothing about size
  return source_height > k_least_height && target_height > k_least_height ? target_height / source_height : 1.0;
}

} // namespace

Clip retarget(const Clip& clip, const Skeleton& source, const Skeleton& target, std::vector<std::string>* unmatched) {
  const std::vector<int> partner = paired_sources(source, target);
  const std::vector<int> above = paired_parents(target, partner);
  std::vector<bool> used(source.joint_count(), false);
  int pairs = 0;
  for (const int s : partner) {
    if (s == k_unpaired) continue;
    used[s] = true;
    ++pairs;
  }
  if (pairs == 0)
    throw InputError("", "clip " + clip.name, "no joint name that both skeletons have",
                     "skeletons with joints in common");
  if (unmatched) {
    unmatched->clear();
    for (int s = 0; s < source.joint_count(); ++s)
      if (!used[s]) unmatched->push_back(source.names[s]);
  }

  const std::vector<Transform> source_rest = rest_model(source), target_rest = rest_model(target);
  const std::vector<Quat> alignment = alignments(partner, above, source_rest, target_rest);

  Clip result;
  result.name = clip.name;
  result.extrapolation = clip.extrapolation;
  result.joint_count = target.joint_count();
  result.times = clip.times;
  result.local.reserve(clip.times.size() * target.rest_local.size());
  std::vector<Transform> source_model(source.joint_count()), target_model(target.joint_count());
  for (int k = 0; k < static_cast<int>(clip.times.size()); ++k) {
    model_from_local(source, clip.key(k), source_model);
    for (int t = 0; t < target.joint_count(); ++t) {
      const int parent = target.parents[t], s = partner[t];
      const Transform model_from_parent = parent == k_no_parent ? Transform() : target_model[parent];
      Transform local = target.rest_local[t];
      if (s != k_unpaired) {
        const Quat away = source_model[s].rotation * source_rest[s].rotation.conjugate();
        local.rotation =
            (model_from_parent.rotation.conjugate() * away * alignment[t] * target_rest[t].rotation).normalized();
        if (above[t] == k_no_parent) {
          const Vec3 &from = source_rest[s].translation, &rest = target_rest[t].translation;
          const Vec3 travelled = travel_ratio(from.y(), rest.y()) * (source_model[s].translation - from);
          local.translation = model_from_parent.inverse() * Vec3(rest + travelled);
        }
      }
      target_model[t] = model_from_parent * local;
      result.local.push_back(local);
    }
  }
  result.roots = roots_of(target);
  if (partner[result.roots.front()] != k_unpaired) {
    result.airborne = clip.airborne;
    make_flights(result, "");
  } else {
    result.airborne.assign(clip.times.size(), false);
  }
  set_interpolation(result, clip.interpolation);
  return result;
}

} // namespace tutu::rig
