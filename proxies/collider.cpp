#include "proxies/collider.h"

namespace tutu::proxies {

Vec3 Anchor::place(std::span<const Transform> world_from_joint) const {
  Vec3 world = weights[0] * (world_from_joint[joints[0]] * points[0]);
  for (int k = 1; k < count; ++k) world += weights[k] * (world_from_joint[joints[k]] * points[k]);
  return world;
}

} // namespace tutu::proxies
