// Seeded random skeletons, poses and clips for the tests of rig.
#pragma once

#include "rig/clip.h"
#include "rig/skeleton.h"

#include <random>
#include <string>

namespace tutu::test {

inline Quat random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  return Quat(gauss(random), gauss(random), gauss(random), gauss(random)).normalized();
}

inline Vec3 random_vector(std::mt19937_64& random, double size = 1.0) {
  std::normal_distribution<double> gauss(0.0, size);
  return {gauss(random), gauss(random), gauss(random)};
}

/// A tree with one root; joints "J0", "J1", ...; bones of some decimetres.
inline rig::Skeleton random_skeleton(std::mt19937_64& random, int joints) {
  rig::Skeleton skeleton;
  for (int j = 0; j < joints; ++j) {
    skeleton.names.push_back("J" + std::to_string(j));
    skeleton.parents.push_back(j == 0 ? rig::k_no_parent
                                      : std::uniform_int_distribution<int>(std::max(0, j - 4), j - 1)(random));
    skeleton.rest_local.push_back({random_rotation(random), random_vector(random, 0.2)});
  }
  return skeleton;
}

inline std::vector<Transform> random_pose(std::mt19937_64& random, const rig::Skeleton& skeleton) {
  std::vector<Transform> local = skeleton.rest_local;
  for (Transform& joint : local) joint.rotation = random_rotation(random);
  return local;
}

/// Every joint in every key, key times a fraction of a second apart.
inline rig::RawClip random_clip(std::mt19937_64& random, const rig::Skeleton& skeleton, int keys) {
  std::uniform_real_distribution<double> step(0.01, 0.9);
  rig::RawClip clip;
  clip.file = "random";
  clip.name = "random";
  double time = -0.3;
  for (int k = 0; k < keys; ++k) {
    rig::RawClip::Key& key = clip.keys.emplace_back();
    key.time = time += step(random);
    key.name = "pose " + std::to_string(k);
    for (int j = 0; j < skeleton.joint_count(); ++j)
      key.joints[skeleton.names[j]] = {Vec3(skeleton.rest_local[j].translation + random_vector(random, 0.001)),
                                       random_rotation(random)};
  }
  return clip;
}

} // namespace tutu::test
