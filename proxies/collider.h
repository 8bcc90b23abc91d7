// A proxy as authored, bound to the joints of one skeleton.
#pragma once

#include "proxies/shapes.h"
#include "rig/skeleton.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace tutu::proxies {

/// A point that rides on up to four joints: world = sum_k weights[k] * (world_from_joint[joints[k]] * points[k]).
/// The weights sum to 1. One joint is a point in that joint's frame; several are a virtual skinned vertex.
struct Anchor {
  int count = 0;
  std::array<int, 4> joints = {};
  std::array<double, 4> weights = {};
  std::array<Vec3, 4> points = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}; ///< in the joint's frame, m

  Vec3 place(std::span<const Transform> world_from_joint) const;
};

enum class ProxyKind { sphere, capsule };

/// A proxy: the stand-in shape on its joints. Posed, it is a collider.
struct Proxy {
  std::string name; ///< unique in its set
  ProxyKind kind = ProxyKind::sphere;
  Anchor a, b;           ///< end points; the same twice for a sphere
  double radius = 0.0;   ///< m, > 0; of a capsule at a
  double friction = 0.3; ///< Coulomb coefficient against cloth, >= 0
  bool enabled = true;
  double taper = 0.0; ///< m, added to the radius by b (Capsule); 0 for a sphere
};

} // namespace tutu::proxies
