#include "proxies/query/detail/narrow_phase.h"

#include "proxies/distance/signed_distance.h"

#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/detail/primitive_shape_algorithm/capsule_capsule.h>

#include <vector>

namespace tutu::proxies {
namespace {

/// FCL's pair of capsules is a closed form, right to the last bits also where they overlap; its other pairs and its
/// signed distances are not. So the point is a capsule as well: of no length, and of a radius of 1 m about the origin.
/// The radius buys the normal: FCL gives the point of this unit ball that faces the collider, which is the direction to
/// the axis at full precision even where the point lies on the collider's surface and a difference of witness points
/// would be 0.
const fcl::Capsuled k_unit_ball(1.0, 0.0);
const fcl::Transform3d k_at_origin = fcl::Transform3d::Identity();

/// A rotation whose z axis is the capsule's; the identity for a sphere.
Eigen::Matrix3d frame_along(const Vec3& axis) {
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  const double length = axis.norm();
  if (length <= k_on_axis) return frame;
  frame.col(2) = axis / length;
  frame.col(0) = frame.col(2).unitOrthogonal();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

} // namespace

struct NarrowPhase::Placed {
  std::vector<Capsule> capsules;
  std::vector<fcl::Capsuled> shapes;
  std::vector<fcl::Transform3d> poses; // world_from_capsule; FCL's capsules lie along z about their middle
};

NarrowPhase::NarrowPhase() : placed_(std::make_unique<Placed>()) {}
NarrowPhase::~NarrowPhase() = default;

void NarrowPhase::place(std::span<const Capsule> colliders) {
  placed_->capsules.assign(colliders.begin(), colliders.end());
  placed_->shapes.resize(colliders.size(), k_unit_ball);
  placed_->poses.resize(colliders.size(), fcl::Transform3d::Identity());
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    const Vec3 axis = colliders[i].b - colliders[i].a;
    placed_->shapes[i].radius = colliders[i].radius;
    placed_->shapes[i].lz = axis.norm();
    placed_->poses[i].linear() = frame_along(axis);
    placed_->poses[i].translation() = 0.5 * (colliders[i].a + colliders[i].b);
  }
}

Contact NarrowPhase::contact(const Vec3& point, int collider) const {
  // FCL has no capsule with two radii; as the hull of a mesh or of balls it would be an iteration, right to 1e-6.
  if (placed_->capsules[collider].taper != 0.0) return signed_distance(point, placed_->capsules[collider]);
  // Asked in a frame with the point as origin: nothing is lost far from the world's origin, and the witness is the
  // direction.
  fcl::Transform3d point_from_capsule = placed_->poses[collider];
  point_from_capsule.translation() -= point;
  double gap;
  Vec3 toward_axis, unused;
  fcl::detail::capsuleCapsuleDistance(k_unit_ball, k_at_origin, placed_->shapes[collider], point_from_capsule, &gap,
                                      &toward_axis, &unused);
  const double distance = gap + k_unit_ball.radius;
  const bool on_axis = distance + placed_->shapes[collider].radius <= k_on_axis; // no direction: FCL's is arbitrary
  const Vec3 normal = on_axis ? normal_on_axis(placed_->capsules[collider]) : Vec3(-toward_axis);
  return {distance, normal, point - distance * normal};
}

} // namespace tutu::proxies
