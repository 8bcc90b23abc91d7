#include "src/view/proxy_edit/proxy_handles.h"

#include "proxies/distance/capsule_union.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tutu::app {
namespace {

using proxies::Anchor;
using proxies::Capsule;
using proxies::Proxy;
using proxies::ProxyKind;

bool is_sphere(const Proxy& proxy) { return proxy.kind == ProxyKind::sphere; }

/// Across axis and sight; where the capsule is seen along its axis, and for a sphere, to the right.
Vec3 beside(const Capsule& shape, const Vec3& view_direction) {
  constexpr double k_along = 1e-3; // sine of the angle between axis and sight
  const Vec3 axis = shape.b - shape.a, across = axis.cross(view_direction);
  if (across.norm() > k_along * axis.norm()) return across.normalized();
  const Vec3 right = view_direction.cross(Vec3::UnitY());
  return right.norm() > k_along ? Vec3(right.normalized()) : Vec3(Vec3::UnitX());
}

} // namespace

Capsule posed(const Proxy& proxy, std::span<const Transform> world_from_joint) {
  const Vec3 a = proxy.a.place(world_from_joint);
  return {a, is_sphere(proxy) ? a : proxy.b.place(world_from_joint), proxy.radius, proxy.taper};
}

std::optional<Anchor> anchor_at(const Anchor& anchor, const Vec3& world, const ProxyPose& pose) {
  constexpr double k_flattest = 20.0; // m at rest for a metre in the world, at most
  Anchor moved = anchor;
  if (anchor.count == 1) {
    moved.points[0] = pose.world_from_joint[anchor.joints[0]].inverse() * world;
    return moved;
  }
  moved.count = 0;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  Vec3 shift = Vec3::Zero();
  for (int k = 0; k < anchor.count; ++k) {
    const int joint = anchor.joints[k];
    const Transform world_from_rest = pose.world_from_joint[joint] * pose.rest[joint].inverse();
    turn += anchor.weights[k] * world_from_rest.rotation.toRotationMatrix();
    shift += anchor.weights[k] * world_from_rest.translation;
    if (anchor.weights[k] == 0.0) continue; // of a blend that is all one joint; a skinned point cannot have it
    moved.joints[moved.count] = joint;
    moved.weights[moved.count++] = anchor.weights[k];
  }
  const Eigen::Matrix3d back = turn.inverse();
  if (!(back.norm() < k_flattest)) return std::nullopt;
  const Vec3 at_rest = back * (world - shift);
  for (int k = 0; k < moved.count; ++k) moved.points[k] = pose.rest[moved.joints[k]].inverse() * at_rest;
  return moved;
}

std::optional<Proxy> proxy_at(const Proxy& proxy, const Capsule& shape, const ProxyPose& pose) {
  Proxy result = proxy;
  const Capsule before = posed(proxy, pose.world_from_joint);
  if (shape.a != before.a) { // what stays keeps its bits, and its way of being said
    const auto a = anchor_at(proxy.a, shape.a, pose);
    if (!a) return std::nullopt;
    result.a = *a;
  }
  if (is_sphere(proxy)) {
    result.b = result.a;
  } else if (shape.b != before.b) {
    const auto b = anchor_at(proxy.b, shape.b, pose);
    if (!b) return std::nullopt;
    result.b = *b;
  }
  result.radius = shape.radius;
  result.taper = shape.taper;
  return result;
}

std::vector<Handle> handles_of(const Proxy& proxy, const ProxyPose& pose, const Vec3& view_direction) {
  const Capsule shape = posed(proxy, pose.world_from_joint);
  const Vec3 aside = beside(shape, view_direction);
  const Handle radius_a{HandleKind::radius_a, shape.a + shape.radius_at(0.0) * aside};
  if (is_sphere(proxy)) return {{HandleKind::move, shape.a}, radius_a};
  return {{HandleKind::move, 0.5 * (shape.a + shape.b)},
          {HandleKind::end_a, shape.a},
          {HandleKind::end_b, shape.b},
          radius_a,
          {HandleKind::radius_b, shape.b + shape.radius_at(1.0) * aside}};
}

std::optional<Handle> nearest_handle(const Picture& picture, std::span<const Handle> handles, double x, double y,
                                     double reach) {
  std::optional<Handle> best;
  for (const Handle& handle : handles) {
    const auto seen = project(picture.camera, picture.width, picture.height, handle.place.cast<float>());
    if (!seen) continue;
    const double pixels = (seen->cast<double>() - Eigen::Vector2d(x, y)).norm();
    if (pixels > reach) continue;
    reach = pixels;
    best = handle;
  }
  return best;
}

std::optional<int> proxy_under(const Ray& ray, std::span<const Capsule> shapes) {
  constexpr double k_farthest = 60.0, k_there = 1e-4; // m
  constexpr int k_most_steps = 500;
  proxies::CapsuleUnion all;
  all.assign(shapes);
  double along = 0.0; // no surface is nearer than the distance: that far the ray is free
  for (int step = 0; step < k_most_steps && along < k_farthest; ++step) {
    const auto nearest = all.nearest(ray.origin + along * ray.direction);
    if (nearest.distance < k_there) return nearest.capsule;
    along += nearest.distance;
  }
  return std::nullopt;
}

ProxyDrag::ProxyDrag(const Proxy& start, const Handle& handle, const ProxyPose& pose, const Ray& press,
                     const Vec3& view_direction)
    : start_(start), handle_(handle), pose_(pose), normal_(view_direction),
      hold_(on_plane(press, handle.place, view_direction).value_or(handle.place)),
      shape_(posed(start, pose.world_from_joint)) {}

Proxy ProxyDrag::at(const Ray& ray, bool alone) const {
  const auto point = on_plane(ray, handle_.place, normal_);
  if (!point || *point == hold_) return start_;
  const Vec3 way = *point - hold_;
  Capsule shape = shape_;
  const bool both = start_.taper == 0.0 && !alone;
  const auto grown = [&](const Vec3& end, double radius) {
    return std::max(k_least_radius, radius + way.dot((handle_.place - end).normalized()));
  };
  switch (handle_.kind) {
  case HandleKind::move:
    shape.a += way;
    shape.b += way;
    break;
  case HandleKind::end_a: shape.a += way; break;
  case HandleKind::end_b: shape.b += way; break;
  case HandleKind::radius_a:
    shape.radius = grown(shape_.a, shape_.radius_at(0.0));
    if (!both && !is_sphere(start_)) shape.taper = shape_.radius_at(1.0) - shape.radius;
    break;
  case HandleKind::radius_b: {
    const double radius = grown(shape_.b, shape_.radius_at(1.0));
    if (both) shape.radius = radius;
    else shape.taper = radius - shape.radius;
    break;
  }
  }
  return proxy_at(start_, shape, pose_).value_or(start_);
}

} // namespace tutu::app
