// The skinned body and its proxies at any time of the motion, without a simulation.
#pragma once

#include "proxies/motion/collider_set.h"
#include "src/run/scene.h"

#include <span>
#include <vector>

namespace tutu::app {

/// One serves one thread. The scene must outlive it.
class PosedBody {
public:
  explicit PosedBody(const Scene& scene);

  void pose_at(double time); ///< s since the motion's start; joints, skin and colliders as a Session has them there

  std::span<const Transform> world_from_joint() const { return world_; }
  std::span<const Vec3f> positions() const { return positions_; } ///< world, m
  std::span<const Vec3f> normals() const { return normals_; }
  std::span<const proxies::Capsule> colliders() const { return colliders_.swept().end; }
  const std::vector<proxies::Proxy>& proxies() const { return colliders_.proxies(); } ///< in collider order

private:
  const Scene* scene_;
  std::vector<Transform> local_, world_;
  std::vector<rig::SkinMatrix> palette_;
  std::vector<Vec3f> positions_, normals_;
  proxies::ColliderSet colliders_;
};

} // namespace tutu::app
