// Handles on a posed proxy, and what a drag of one makes of the proxy as authored.
#pragma once

#include "proxies/collider.h"
#include "rig/skeleton.h"
#include "src/view/window/pick.h"

#include <optional>
#include <span>
#include <vector>

namespace tutu::app {

/// No drag makes a radius less, m.
inline constexpr double k_least_radius = 1e-3;

/// The joints at the pose that is edited in, and at rest. World is model space. Does not own them.
struct ProxyPose {
  std::span<const Transform> world_from_joint, rest;
};

proxies::Capsule posed(const proxies::Proxy& proxy, std::span<const Transform> world_from_joint);

/// The anchor on the same joints that is at `world` in this pose. On one joint
///   p = world_from_joint^-1 world;
/// on several it is one point P of the rest pose, as a file has it, with
///   sum_k w_k (world_from_joint_k rest_k^-1) P = world.
/// A blend of two joints' origins becomes such a point. None where these joints take all points of the rest pose to a
/// plane, or nearly.
std::optional<proxies::Anchor> anchor_at(const proxies::Anchor& anchor, const Vec3& world, const ProxyPose& pose);

/// A proxy on the same joints whose posed shape is `shape`. None as anchor_at.
std::optional<proxies::Proxy> proxy_at(const proxies::Proxy& proxy, const proxies::Capsule& shape,
                                       const ProxyPose& pose);

enum class HandleKind { move, end_a, end_b, radius_a, radius_b };

struct Handle {
  HandleKind kind = HandleKind::move;
  Vec3 place = Vec3::Zero(); ///< world
};

/// Of a sphere: its centre (move) and radius_a. Of a capsule: its middle, both ends, and a radius at each. A radius
/// stands beside its end, across the axis and the line of sight: to the right of a sphere.
/// `view_direction`: along which the camera looks, unit.
std::vector<Handle> handles_of(const proxies::Proxy& proxy, const ProxyPose& pose, const Vec3& view_direction);

/// The handle whose place in the picture is nearest to the pointer, within `reach` px.
std::optional<Handle> nearest_handle(const Picture& picture, std::span<const Handle> handles, double x, double y,
                                     double reach);

/// The shape whose surface the ray meets first; of what holds the eye, none is met before it.
std::optional<int> proxy_under(const Ray& ray, std::span<const proxies::Capsule> shapes);

/// One drag. Every state is made from the start, so that a pointer that comes back brings the proxy back, to the bit.
///
/// With d the way of the pointer in the plane through the handle that faces the camera, from where it took hold:
///   move    both ends go by d
///   end     goes by d
///   radius  grows by d . u, u from the axis to the handle; of a capsule with one radius both, else (or `alone`: one
///           radius becomes two) that end's
class ProxyDrag {
public:
  ProxyDrag(const proxies::Proxy& start, const Handle& handle, const ProxyPose& pose, const Ray& press,
            const Vec3& view_direction);

  proxies::Proxy at(const Ray& ray, bool alone = false) const;

private:
  proxies::Proxy start_;
  Handle handle_;
  ProxyPose pose_;
  Vec3 normal_, hold_;
  proxies::Capsule shape_;
};

} // namespace tutu::app
