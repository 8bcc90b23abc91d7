#include "src/study/stability/scene_setting.h"

#include "cloth/garment/vibration.h"
#include "cloth/solver.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"
#include "proxies/motion/collider_set.h"
#include "src/run/garment_reach.h"
#include "src/run/posed_body.h"
#include "src/run/session.h"
#include "src/study/stability/step_bound.h"
#include "src/study/stability/trials.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tutu::app {
namespace {

/// Poses in which the garments' reach is asked; limbs do not go far from one to the next.
constexpr int k_reach_poses = 60;

GarmentSetting garment_setting(const cloth::Garment& garment, const RunSettings& description) {
  GarmentSetting setting;
  setting.name = garment.name;
  setting.gap = garment.fabric.contact_offset();
  setting.step_limit = largest_stable_step(garment);
  // Frequencies go with 1 / cell: one patch tells all.
  Patch patch;
  patch.fabric = garment.fabric;
  const double vibration = cloth::fastest_vibration(garment);
  if (vibration > 0.0) setting.stiffest_cell = patch.cell * cloth::fastest_vibration(garment_of(patch)) / vibration;
  for (int k = 0; k < garment.structural_count; ++k)
    setting.largest_cell = std::max(setting.largest_cell, garment.springs[k].rest_length);
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment);
  double lightest = std::numeric_limits<double>::infinity(), heaviest = 0.0;
  for (int i = 0; i < garment.particle_count(); ++i) {
    if (pinned[i]) continue;
    lightest = std::min(lightest, garment.masses[i]);
    heaviest = std::max(heaviest, garment.masses[i]);
  }
  if (heaviest > 0.0) setting.mass_ratio = heaviest / lightest;
  setting.only_particles =
      cloth::honoured(description, garment, description.backend).features == cloth::ContactFeatures::particles;
  return setting;
}

class Poser {
public:
  explicit Poser(const Scene& scene) : scene_(&scene), local_(scene.character.skeleton.rest_local) {
    world_.resize(local_.size());
  }
  const std::vector<Transform>& at(double time) {
    rig::pose_at(scene_->motion, scene_->character.skeleton, time, local_, world_);
    return world_;
  }

private:
  const Scene* scene_;
  std::vector<Transform> local_, world_;
};

std::vector<ProxySetting> proxies_of(const Scene& scene) {
  Poser poser(scene);
  const double frame_seconds = 1.0 / scene.settings.frames_per_second;
  const int frames = frames_of(scene);
  std::vector<std::vector<Transform>> poses;
  for (int k = 0; k < std::min(k_reach_poses, frames + 1); ++k)
    poses.push_back(poser.at(scene.motion.duration() * k / k_reach_poses));

  proxies::ColliderSet colliders(scene.proxies, std::nullopt);
  std::vector<double> speeds(static_cast<std::size_t>(colliders.size()), 0.0);
  const int moments = std::min(frames, k_most_moments);
  for (int k = 0; k < moments; ++k) {
    const auto frame = static_cast<int>(static_cast<long>(k) * frames / moments);
    colliders.reset(poser.at(frame * frame_seconds));
    colliders.advance(poser.at((frame + 1) * frame_seconds));
    const proxies::SweptColliders swept = colliders.swept();
    for (std::size_t c = 0; c < speeds.size(); ++c) {
      const double speed = proxies::farthest_way(swept.start[c], swept.end[c]) / frame_seconds;
      if (speed <= k_teleport_speed) speeds[c] = std::max(speeds[c], speed); // a cut is no motion
    }
  }
  const auto clearance =
      garment_clearance(scene.character, scene.garments, scene.attachment_joints, poses, colliders.proxies());
  std::vector<ProxySetting> proxies;
  for (std::size_t c = 0; c < speeds.size(); ++c)
    if (!clearance[c] || *clearance[c] <= 0.0)
      proxies.push_back({colliders.proxies()[c].name, colliders.proxies()[c].radius, speeds[c]});
  return proxies;
}

} // namespace

SceneSetting scene_setting(const Scene& scene) {
  SceneSetting setting;
  setting.step = 1.0 / (scene.settings.frames_per_second * static_cast<double>(scene.settings.substeps));
  for (const cloth::Garment& garment : scene.garments)
    setting.garments.push_back(garment_setting(garment, scene.settings));
  if (scene.settings.backend != proxies::Backend::mesh) setting.proxies = proxies_of(scene);
  return setting;
}

namespace {

/// The entry with the smallest `key`; null for none.
template <class T, class Key> const T* least(const std::vector<T>& entries, const Key& key) {
  const auto found =
      std::min_element(entries.begin(), entries.end(), [&](const T& a, const T& b) { return key(a) < key(b); });
  return found == entries.end() ? nullptr : &*found;
}

} // namespace

double least_gap(const SceneSetting& setting) {
  const GarmentSetting* found = least(setting.garments, [](const GarmentSetting& g) { return g.gap; });
  return found ? found->gap : 0.0;
}

const GarmentSetting* stiffest(const SceneSetting& setting) {
  return least(setting.garments, [](const GarmentSetting& g) { return g.step_limit; });
}

const GarmentSetting* coarsest(const SceneSetting& setting) {
  return least(setting.garments, [](const GarmentSetting& g) { return -g.largest_cell; });
}

const ProxySetting* fastest(const SceneSetting& setting) {
  const double gap = least_gap(setting);
  return least(setting.proxies, [gap](const ProxySetting& p) { return -p.speed / (p.radius + gap); });
}

const ProxySetting* thinnest(const SceneSetting& setting) {
  return least(setting.proxies, [](const ProxySetting& p) { return p.radius; });
}

StartOverlap start_overlap(const Scene& scene, std::span<const std::vector<Vec3>> garment_positions) {
  Poser poser(scene);
  proxies::ColliderSet colliders(scene.proxies, std::nullopt);
  colliders.reset(poser.at(0.0));
  StartOverlap overlap;
  for (std::size_t g = 0; g < garment_positions.size(); ++g) {
    const std::vector<std::uint8_t> pinned = cloth::pinned_flags(scene.garments[g]);
    for (std::size_t i = 0; i < garment_positions[g].size(); ++i) {
      if (pinned[i]) continue;
      for (int c = 0; c < colliders.size(); ++c) {
        const proxies::Capsule& capsule = colliders.swept().end[c];
        const double depth = -proxies::signed_distance(garment_positions[g][i], capsule).distance;
        if (depth > overlap.depth)
          overlap = {depth, capsule.radius, scene.garments[g].name, colliders.proxies()[c].name};
      }
    }
  }
  return overlap;
}

} // namespace tutu::app
